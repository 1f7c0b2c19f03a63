// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "cut/cutter_state.hpp"

namespace resect {
namespace {

/// FNV-1a over 64-bit words, with a last shift so that high bits reach low ones.
class Hash {
public:
    void add(std::uint64_t word) {
        value_ = (value_ ^ word) * 0x100000001b3U;
        value_ ^= value_ >> 29U;
    }
    void add(Index index) { add(std::uint64_t{static_cast<std::uint32_t>(index)}); }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    template <class T, std::size_t n>
    void add(const std::array<T, n>& values) {
        for (const T& value : values) {
            add(value);
        }
    }
    template <class T>
    void add(const std::vector<T>& values) {
        add(std::uint64_t{values.size()});
        for (const T& value : values) {
            add(value);
        }
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325U;
};

} // namespace

std::uint64_t hash_topology(const Cutter& cutter) {
    Hash hash;
    const SimulationMesh& mesh = cutter.mesh;
    hash.add(mesh.copy_node);
    hash.add(mesh.copy_element);
    hash.add(mesh.copy_fraction);
    hash.add(mesh.copy_weight);
    hash.add(mesh.node_reference);
    hash.add(mesh.node_mass);
    hash.add(mesh.node_home);
    for (const std::uint8_t held : mesh.node_held) {
        hash.add(Index{held});
    }
    for (const MaterialTet& tet : cutter.material.tets) {
        hash.add(tet.vertex);
        hash.add(tet.link);
        hash.add(tet.label);
        hash.add(tet.copy);
        hash.add(tet.volume);
    }
    hash.add(cutter.material.rest);
    return hash.value();
}

} // namespace resect
