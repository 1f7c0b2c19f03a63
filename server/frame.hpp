// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "message.hpp"

namespace server {

/// What the header of a frame says beside its counts (docs/protocol.md, "Frames").
struct FrameHeader {
    std::uint32_t frame = 0;
    std::uint32_t message = 0; // of the driver, the last whose effect is shown
    std::uint32_t scene = 0;
    double time = 0, step = 0;
};

/// What a client has, and wants.
struct FrameRequest {
    std::uint64_t since_revision = 0; // of the topology, as the frame before said; 0: none
    Show show = {};
    bool has_elements = false; // of this revision

    bool operator==(const FrameRequest&) const = default;
};

/// The surface of now and what of the topology changed since `since_revision`.
std::string build_frame(resect::Simulation& simulation, const FrameHeader& header,
                        const FrameRequest& request, std::uint64_t& revision);

/// A file on its way to the page.
std::string build_file(const std::string& name, std::string_view content);

/// A file on its way from the page.
resect::Result<Upload> parse_upload(std::string_view bytes);

} // namespace server
