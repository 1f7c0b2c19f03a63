// SPDX-License-Identifier: Apache-2.0
#include "frame.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

namespace server {

namespace {

using namespace resect;

static_assert(std::endian::native == std::endian::little, "frames are little-endian");

constexpr std::uint32_t magic = 0x54435352; // "RSCT"
constexpr std::uint16_t version = 1;
constexpr std::size_t alignment = 8;

enum class Kind : std::uint16_t { surface = 1, file = 2 };

enum class Section : std::uint32_t {
    position = 1,
    normal = 2,
    triangle = 3,
    face = 4,
    piece = 5,
    rest = 6,
    stress = 7,
    node = 8,
    element = 9,
    name = 16,
    bytes = 17,
};

struct Header {
    std::uint32_t magic = 0;
    std::uint16_t version = 0;
    Kind kind = {};
    std::uint32_t frame = 0, message = 0;
    double time = 0, step = 0;
    std::uint32_t scene = 0, revision = 0;
    std::uint32_t vertices = 0, triangles = 0, nodes = 0, elements = 0;
    std::uint32_t sections = 0, zero = 0;
};
static_assert(sizeof(Header) == 64);

struct SectionHeader {
    Section type = {};
    std::uint32_t first = 0, rows = 0, bytes = 0;
};
static_assert(sizeof(SectionHeader) == 16);

template <class T>
std::uint32_t count(const T& rows) {
    return static_cast<std::uint32_t>(rows.size());
}

/// A header, and sections one after the other.
class FrameBytes {
public:
    explicit FrameBytes(const Header& header) : header_(header), bytes_(sizeof(Header), '\0') {}

    template <class T>
    void add(Section type, std::span<const T> rows, std::uint32_t first = 0) {
        const SectionHeader section = {type, first, count(rows),
                                       static_cast<std::uint32_t>(rows.size_bytes())};
        append(&section, sizeof(section));
        append(rows.data(), rows.size_bytes());
        bytes_.resize((bytes_.size() + alignment - 1) / alignment * alignment, '\0');
        ++header_.sections;
    }

    std::string finish() {
        header_.magic = magic;
        header_.version = version;
        std::memcpy(bytes_.data(), &header_, sizeof(Header));
        return std::move(bytes_);
    }

private:
    void append(const void* from, std::size_t size) {
        if (size > 0) { bytes_.append(static_cast<const char*>(from), size); }
    }

    Header header_;
    std::string bytes_;
};

using Normal = std::array<std::int16_t, 4>;

std::vector<Normal> shorten(std::span<const Vec3f> normals) {
    std::vector<Normal> shortened;
    shortened.reserve(normals.size());
    for (const Vec3f& n : normals) {
        const auto part = [&](std::size_t k) { return static_cast<std::int16_t>(32767.0F * n[k]); };
        shortened.push_back({part(0), part(1), part(2), 0});
    }
    return shortened;
}

/// [vertex] Von Mises, Pa: means over the triangles around.
std::vector<float> stress_of_vertices(Simulation& simulation, const Surface& surface) {
    const std::vector<double> of_copies = simulation.von_mises();
    const std::vector<Index> copies = simulation.surface_copies();
    std::vector<float> sum(surface.position.size(), 0.0F), uses(surface.position.size(), 0.0F);
    for (std::size_t t = 0; t < copies.size(); ++t) {
        for (const Index corner : surface.triangle[t]) {
            const auto at = static_cast<std::size_t>(corner);
            sum[at] += static_cast<float>(of_copies[static_cast<std::size_t>(copies[t])]);
            uses[at] += 1.0F;
        }
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] /= std::max(uses[i], 1.0F);
    }
    return sum;
}

std::vector<Vec3f> places_of(const Nodes& nodes) {
    std::vector<Vec3f> places(nodes.rest.begin(), nodes.rest.end());
    for (std::size_t n = 0; n < places.size(); ++n) {
        for (std::size_t k = 0; k < 3; ++k) {
            places[n][k] += nodes.displacement[n][k];
        }
    }
    return places;
}

template <class T>
std::span<const T> rows_in(std::span<const T> rows, const Range& range) {
    return rows.subspan(static_cast<std::size_t>(range.begin),
                        static_cast<std::size_t>(range.end - range.begin));
}

void add_topology(FrameBytes& bytes, const Surface& surface) {
    for (const Range& range : surface.dirty) {
        const auto first = static_cast<std::uint32_t>(range.begin);
        bytes.add(Section::triangle, rows_in(surface.triangle, range), first);
        bytes.add(Section::face, rows_in(surface.face, range), first);
        bytes.add(Section::piece, rows_in(surface.piece, range), first);
    }
    for (const Range& range : surface.dirty_vertices) {
        bytes.add(Section::rest, rows_in(surface.rest, range), static_cast<std::uint32_t>(range.begin));
    }
}

} // namespace

std::string build_frame(Simulation& simulation, const FrameHeader& header, const FrameRequest& request,
                        std::uint64_t& revision) {
    const Surface surface = simulation.surface(request.since_revision);
    revision = surface.revision;
    const Nodes nodes = simulation.nodes();
    const Copies copies = simulation.copies();
    const bool elements = request.show.elements;
    FrameBytes bytes({.kind = Kind::surface,
                      .frame = header.frame,
                      .message = header.message,
                      .time = header.time,
                      .step = header.step,
                      .scene = header.scene,
                      .revision = static_cast<std::uint32_t>(surface.revision),
                      .vertices = count(surface.position),
                      .triangles = count(surface.triangle),
                      .nodes = elements ? count(nodes.rest) : 0,
                      .elements = elements ? count(copies.node) : 0});
    bytes.add(Section::position, surface.position);
    bytes.add<Normal>(Section::normal, shorten(surface.normal));
    if (surface.revision != request.since_revision) { add_topology(bytes, surface); }
    if (request.show.stress) { bytes.add<float>(Section::stress, stress_of_vertices(simulation, surface)); }
    if (elements) {
        bytes.add<Vec3f>(Section::node, places_of(nodes));
        if (!request.has_elements || surface.revision != request.since_revision) {
            bytes.add(Section::element, copies.node);
        }
    }
    return bytes.finish();
}

std::string build_file(const std::string& name, std::string_view content) {
    FrameBytes bytes({.kind = Kind::file});
    bytes.add(Section::name, std::span(name.data(), name.size()));
    bytes.add(Section::bytes, std::span(content.data(), content.size()));
    return bytes.finish();
}

Result<Upload> parse_upload(std::string_view bytes) {
    const Error broken = {"a binary message is a file as docs/protocol.md describes it; this is none"};
    Header header;
    if (bytes.size() < sizeof(Header)) { return broken; }
    std::memcpy(&header, bytes.data(), sizeof(Header));
    if (header.magic != magic || header.version != version || header.kind != Kind::file) { return broken; }
    Upload upload;
    std::size_t at = sizeof(Header);
    for (std::uint32_t i = 0; i < header.sections; ++i) {
        SectionHeader section;
        if (bytes.size() - at < sizeof(section)) { return broken; }
        std::memcpy(&section, bytes.data() + at, sizeof(section));
        at += sizeof(section);
        if (bytes.size() - at < section.bytes) { return broken; }
        if (section.type == Section::name) { upload.name = bytes.substr(at, section.bytes); }
        if (section.type == Section::bytes) { upload.bytes = bytes.substr(at, section.bytes); }
        at = std::min(bytes.size(), at + (section.bytes + alignment - 1) / alignment * alignment);
    }
    if (upload.name.empty() || upload.bytes.empty()) { return broken; }
    return upload;
}

} // namespace server
