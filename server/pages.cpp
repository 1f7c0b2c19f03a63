// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <utility>

#include "network.hpp"

namespace server {

namespace {

const char* type_of(const std::string& ending) {
    static constexpr std::array<std::pair<const char*, const char*>, 8> types = {
        {{".html", "text/html; charset=utf-8"},
         {".js", "text/javascript; charset=utf-8"},
         {".css", "text/css; charset=utf-8"},
         {".json", "application/json"},
         {".svg", "image/svg+xml"},
         {".png", "image/png"},
         {".webp", "image/webp"},
         {".ico", "image/x-icon"}}};
    for (const auto& [known, type] : types) {
        if (ending == known) { return type; }
    }
    return "application/octet-stream";
}

} // namespace

Pages load_pages(const std::string& folder) {
    Pages pages;
    std::error_code none;
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder, none)) {
        if (!file.is_regular_file()) { continue; }
        std::ifstream stream(file.path(), std::ios::binary);
        Page page = {{std::istreambuf_iterator<char>(stream), {}}, type_of(file.path().extension().string())};
        const std::string path = fmt::format("/{}", file.path().lexically_relative(folder).generic_string());
        if (path == "/index.html") { pages["/"] = page; }
        pages[path] = std::move(page);
    }
    return pages;
}

} // namespace server
