// SPDX-License-Identifier: Apache-2.0
#include "lab/report.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace lab {

using namespace resect;
using Json = nlohmann::ordered_json;

namespace {

namespace fs = std::filesystem;

constexpr const char* place = "<!-- report -->"; // of the page, where the findings go

Result<void> write_text(const fs::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) {
        return Error{
            fmt::format("{}: cannot be written; give a folder that may be written to", path.string())};
    }
    return {};
}

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

std::string to_base64(const std::string& bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto byte = i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
            three = three << 8U | byte;
        }
        for (std::size_t k = 0; k < 4; ++k) {
            const bool is_filled = i + k <= bytes.size();
            text += is_filled ? digits[three >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

/// As CSV has it (RFC 4180).
std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) { return text; }
    std::string quote = "\"";
    for (const char c : text) {
        quote.append(c == '"' ? 2 : 1, c);
    }
    quote.push_back('"');
    return quote;
}

class Writer {
public:
    explicit Writer(fs::path folder) : folder_(std::move(folder)) {}

    Result<Json> write(const Plot& plot) {
        std::string csv = fmt::format("series,{},{}\n", quoted(plot.x_label), quoted(plot.y_label));
        Json series = Json::array();
        for (const Series& one : plot.series) {
            for (std::size_t i = 0; i < one.x.size(); ++i) {
                csv += fmt::format("{},{:.9g},{:.9g}\n", quoted(one.name), one.x[i], one.y[i]);
            }
            series.push_back({{"name", one.name}, {"x", one.x}, {"y", one.y}, {"points", one.points}});
        }
        const Result<void> written = write_text(folder_ / (plot.name + ".csv"), csv);
        if (!written) { return written.error(); }
        return Json{{"kind", "plot"},      {"name", plot.name},       {"title", plot.title},
                    {"says", plot.says},   {"x_label", plot.x_label}, {"y_label", plot.y_label},
                    {"log_x", plot.log_x}, {"log_y", plot.log_y},     {"series", series}};
    }

    Result<Json> write(const Table& table) {
        std::string csv = line(table.columns);
        for (const auto& row : table.rows) {
            csv += line(row);
        }
        const Result<void> written = write_text(folder_ / (table.name + ".csv"), csv);
        if (!written) { return written.error(); }
        return Json{{"kind", "table"},    {"name", table.name},       {"title", table.title},
                    {"says", table.says}, {"columns", table.columns}, {"rows", table.rows}};
    }

    Result<Json> write(const Strip& strip) {
        std::error_code failed;
        fs::create_directories(folder_ / strip.name, failed);
        Json surfaces = Json::array();
        for (const Still& still : strip.stills) {
            const fs::path path = folder_ / strip.name / (still.caption + ".vtp");
            const Result<void> written = write_surface_file(path.string(), still.surface);
            if (!written) { return written.error(); }
            surfaces.push_back({{"name", path.filename().string()},
                                {"caption", still.caption},
                                {"base64", to_base64(read_text(path))}});
        }
        return Json{{"kind", "strip"},
                    {"name", strip.name},
                    {"title", strip.title},
                    {"says", strip.says},
                    {"surfaces", surfaces},
                    {"camera",
                     {{"eye", strip.camera.eye},
                      {"target", strip.camera.target},
                      {"fov", strip.camera.field_of_view}}}};
    }

private:
    static std::string line(const std::vector<std::string>& words) {
        std::string text;
        for (const std::string& word : words) {
            text += fmt::format("{}{}", text.empty() ? "" : ",", quoted(word));
        }
        return text + '\n';
    }

    fs::path folder_;
};

} // namespace

Result<void> write_report(const std::string& folder, const Report& report, const std::string& page) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    std::string html = read_text(page);
    const std::size_t at = html.find(place);
    if (at == std::string::npos) {
        return Error{fmt::format("{}: is no report page; ./run builds it", page)};
    }
    Writer writer(folder);
    Json sections = Json::array();
    for (const Section& section : report.sections) {
        Json parts = Json::array();
        for (const auto& part : section.parts) {
            const Result<Json> json = std::visit([&](const auto& of) { return writer.write(of); }, part);
            if (!json) { return json.error(); }
            parts.push_back(*json);
        }
        sections.push_back({{"title", section.title}, {"text", section.text}, {"parts", parts}});
    }
    std::string found =
        Json{{"title", report.title}, {"machine", report.machine}, {"sections", sections}}.dump();
    for (std::size_t end = found.find("</"); end != std::string::npos; end = found.find("</", end + 2)) {
        found.replace(end, 2, "<\\/"); // it would end the script that holds it
    }
    html.replace(at, std::string(place).size(),
                 fmt::format("<script type=\"application/json\" id=\"report\">{}</script>", found));
    return write_text(fs::path(folder) / "index.html", html);
}

std::string number(double value, int digits) { return fmt::format("{:.{}g}", value, digits); }

} // namespace lab
