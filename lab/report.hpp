// SPDX-License-Identifier: Apache-2.0
// What the lab found, as one page that draws itself in the reader's browser, and as CSV files beside it.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "resect/result.hpp"

#include "lab/surface.hpp"

namespace lab {

struct Series {
    std::string name = {};
    std::vector<double> x = {}, y = {};
    bool points = false; // no line
};

/// Every part has a name, which its files have too, and a sentence that says what it shows.
struct Plot {
    std::string name = {}, title = {}, says = {};
    std::string x_label = {}, y_label = {}; // with units
    bool log_x = false, log_y = false;
    std::vector<Series> series = {};
};

struct Table {
    std::string name = {}, title = {}, says = {};
    std::vector<std::string> columns = {};
    std::vector<std::vector<std::string>> rows = {};
};

struct Still {
    std::string caption = {};
    CutSurface surface = {};
};

struct Camera {
    Vec3 eye = {}, target = {}; // m
    double field_of_view = 30;  // degrees
};

/// Surfaces side by side, seen by one camera.
struct Strip {
    std::string name = {}, title = {}, says = {};
    std::vector<Still> stills = {};
    Camera camera = {};
};

struct Section {
    std::string title = {};
    std::vector<std::string> text = {}; // paragraphs
    std::vector<std::variant<Plot, Table, Strip>> parts = {};
};

struct Report {
    std::string title = {}, machine = {};
    std::vector<Section> sections = {};
};

/// Writes index.html, made of the page at `page` (web/dist/report.html), a .csv for each plot and table and a
/// folder of .vtp surfaces for each strip.
resect::Result<void> write_report(const std::string& folder, const Report& report, const std::string& page);

/// A number of `digits` significant digits.
std::string number(double value, int digits = 3);

} // namespace lab
