// SPDX-License-Identifier: Apache-2.0
#include "io/file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <memory>
#include <system_error>
#include <unistd.h>

#include "io/refuse.hpp"

namespace resect {

namespace {

namespace fs = std::filesystem;

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

Error not_written(const std::string& path, int code) {
    const char* mend = "check the path and the free space";
    if (code == ENOENT) { mend = "its folder does not exist: make it first"; }
    if (code == EACCES || code == EPERM || code == EROFS) { mend = "choose a place that you may write to"; }
    if (code == ENOSPC) { mend = "free some space or choose another disk"; }
    return {fmt::format("{}: cannot be written ({}); {}", path, std::strerror(code), mend)};
}

/// The error number; 0 where all bytes are written.
int write_bytes(const std::string& path, std::string_view bytes) {
    File file(std::fopen(path.c_str(), "wb"));
    if (!file) { return errno; }
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) { return errno; }
    return std::fclose(file.release()) == 0 ? 0 : errno;
}

} // namespace

std::string read_file(const std::string& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) { refuse(path + ": is a folder; name a file in it"); }
    const File file(std::fopen(path.c_str(), "rb"));
    if (!file) { refuse(fmt::format("{}: cannot be read ({}); check the path", path, std::strerror(errno))); }
    std::string bytes;
    char chunk[65536];
    while (const std::size_t count = std::fread(chunk, 1, sizeof chunk, file.get())) {
        bytes.append(chunk, count);
    }
    if (std::ferror(file.get()) != 0) {
        refuse(fmt::format("{}: reading it failed ({}); check the disk", path, std::strerror(errno)));
    }
    return bytes;
}

Result<void> write_file(const std::string& path, std::string_view bytes) {
    std::error_code failure;
    const bool exists = fs::exists(path, failure);
    if (exists && fs::is_directory(path, failure)) {
        return Error{path + ": is a folder; name a file in it"};
    }
    if (exists && !fs::is_regular_file(path, failure)) {
        const int code = write_bytes(path, bytes);
        return code == 0 ? Result<void>{} : not_written(path, code);
    }
    const std::string target = exists ? fs::canonical(path, failure).string() : path; // behind a link
    const std::string part = fmt::format("{}.{}.part", target, getpid());
    int code = write_bytes(part, bytes);
    if (code == 0) {
        fs::rename(part, target, failure);
        code = failure.value();
    }
    if (code == 0) { return {}; }
    fs::remove(part, failure);
    return not_written(path, code);
}

std::string ending_of(const std::string& path) {
    std::string ending = fs::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return ending;
}

std::string beside(const std::string& file, const std::string& path) {
    return (fs::path(file).parent_path() / path).string();
}

} // namespace resect
