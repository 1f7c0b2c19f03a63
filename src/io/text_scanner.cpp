// SPDX-License-Identifier: Apache-2.0
#include "io/text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "io/refuse.hpp"

namespace resect {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

/// For a message: short, and without what would break its line.
std::string shown(std::string_view word) {
    constexpr std::size_t most = 30;
    std::string text;
    for (const char c : word.substr(0, most)) {
        text += ' ' <= c && c <= '~' ? c : '?';
    }
    return word.size() > most ? text + "..." : text;
}

template <class T>
bool parse_whole(std::string_view word, T& value) {
    if (word.starts_with('+')) { word.remove_prefix(1); }
    const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
    return failure == std::errc{} && end == word.data() + word.size();
}

} // namespace

void TextScanner::refuse(const std::string& why) const {
    resect::refuse(fmt::format("{}:{}: {}", file_, line_, why));
}

void TextScanner::skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) {
        if (text_[at_++] == '\n') { ++line_; }
    }
}

bool TextScanner::is_at_end() {
    skip_blanks();
    return at_ == text_.size();
}

std::string_view TextScanner::word(const char* what) {
    if (is_at_end()) { refuse(fmt::format("the file ends before {}; it was cut off: write it again", what)); }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) {
        ++at_;
    }
    return text_.substr(begin, at_ - begin);
}

std::string_view TextScanner::rest_of_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    if (line.ends_with('\r')) { line.remove_suffix(1); }
    at_ = std::min(end + 1, text_.size());
    if (end < text_.size()) { ++line_; }
    return line;
}

double TextScanner::finite_number(const char* what) {
    const std::string_view text = word(what);
    double value = 0;
    if (!parse_whole(text, value)) {
        refuse(fmt::format("'{}' is no number for {}; mend it", shown(text), what));
    }
    if (!std::isfinite(value)) { refuse(fmt::format("{} is {}; it must be finite", what, shown(text))); }
    return value;
}

std::int64_t TextScanner::integer(const char* what) {
    const std::string_view text = word(what);
    std::int64_t value = 0;
    if (!parse_whole(text, value)) {
        refuse(fmt::format("'{}' is no whole number for {}; mend it", shown(text), what));
    }
    return value;
}

std::size_t TextScanner::count(const char* what, std::size_t least_bytes) {
    const std::int64_t value = integer(what);
    const std::size_t most = (text_.size() - at_) / least_bytes;
    if (value < 0 || static_cast<std::size_t>(value) > most) {
        refuse(fmt::format("{} is {}, but the file has room for {} at most; it was cut off or is wrong there",
                           what, value, most));
    }
    return static_cast<std::size_t>(value);
}

std::string_view TextScanner::bytes(std::size_t size, const char* what) {
    if (size > text_.size() - at_) {
        refuse(fmt::format("the file ends inside {}; it was cut off: write it again", what));
    }
    const std::string_view found = text_.substr(at_, size);
    at_ += size;
    line_ += static_cast<std::size_t>(std::count(found.begin(), found.end(), '\n'));
    return found;
}

void TextScanner::expect(std::string_view expected) {
    const std::string_view found = word(std::string(expected).c_str());
    if (found != expected) {
        refuse(fmt::format("found '{}' in place of {}; mend it", shown(found), expected));
    }
}

void TextScanner::skip_past(std::string_view text) {
    const std::size_t found = text_.find(text, at_);
    if (found == std::string_view::npos) {
        refuse(fmt::format("the file ends before {}; it was cut off: write it again", text));
    }
    bytes(found + text.size() - at_, "a section");
}

} // namespace resect
