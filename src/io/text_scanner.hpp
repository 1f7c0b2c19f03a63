// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace resect {

/// Walks over the words of a file and knows the line. Whatever is not as asked is refused with file and line;
/// `what` names in a message that which is looked for.
class TextScanner {
public:
    TextScanner(std::string_view text, std::string file, std::size_t first_line = 1)
        : text_(text), file_(std::move(file)), line_(first_line) {}

    /// Whether nothing but blanks is left.
    bool is_at_end();
    std::string_view word(const char* what);
    /// What is left of the line, without the line's end.
    std::string_view rest_of_line();
    double finite_number(const char* what);
    std::int64_t integer(const char* what);
    /// How many things follow; more than the rest of the file can hold at `least_bytes` each are refused, so
    /// that what is reserved for them is bounded by the size of the file.
    std::size_t count(const char* what, std::size_t least_bytes = 2);
    /// The next `size` bytes as they are.
    std::string_view bytes(std::size_t size, const char* what);
    void expect(std::string_view expected);
    /// Goes on behind the next `text`.
    void skip_past(std::string_view text);
    bool continues_with(std::string_view text) const { return text_.substr(at_).starts_with(text); }
    [[noreturn]] void refuse(const std::string& why) const;

private:
    void skip_blanks();

    std::string_view text_;
    std::string file_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
};

} // namespace resect
