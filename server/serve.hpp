// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "network.hpp"
#include "theatre.hpp"

namespace server {

struct ServeOptions {
    NetworkOptions network = {};
    TheatreOptions theatre = {};
    std::string pages = {}; // folder
};

/// Serves until a signal ends it; `ready` is called with the port once pages can be opened.
resect::Result<void> serve(const ServeOptions& options, const std::function<void(int port)>& ready);

} // namespace server
