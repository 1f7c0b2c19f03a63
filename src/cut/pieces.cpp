// SPDX-License-Identifier: Apache-2.0
#include "cut/pieces.hpp"

#include <algorithm>
#include <utility>

#include "cut/beside.hpp"

namespace resect {
namespace {

double volume_of(const Cutter& cutter, Index copy) {
    return cutter.mesh.copy_fraction[row(copy)] *
           cutter.element_volume[row(cutter.mesh.copy_element[row(copy)])];
}

/// The copies that were reached from one seed. Floods that meet are a group, named by its lowest flood.
struct Flood {
    Index piece = 0, group = 0;
    Index first = 0, last = 0; // copies, in a list by scratch.next_flooded
    Index next = 0;            // of them, to look around from; -1: done
    Index growing = 0;         // of a group: floods that are not done
};

class Floods {
public:
    explicit Floods(Cutter& cutter) : cutter_(cutter), reached_(cutter.scratch.reached) {
        reached_.clear(cutter.mesh.copy_node.size());
        const std::size_t copies = cutter.mesh.copy_node.size();
        if (cutter.scratch.flood_of.size() < copies) {
            cutter.scratch.flood_of.resize(2 * copies);
            cutter.scratch.next_flooded.resize(2 * copies);
        }
    }

    void start_at(Index copy) {
        if (!reached_.set(copy)) { return; }
        const auto flood = static_cast<Index>(floods_.size());
        const Index piece = cutter_.pieces.of_copy[row(copy)];
        cutter_.scratch.flood_of[row(copy)] = flood;
        cutter_.scratch.next_flooded[row(copy)] = -1;
        floods_.push_back({piece, flood, copy, copy, copy, 1});
        count_open(piece, 1);
    }

    /// Floods in turn until no piece has two groups that can still grow: they might meet.
    void run() {
        while (rivals_ > 0) {
            for (std::size_t f = 0; f < floods_.size(); ++f) {
                step(static_cast<Index>(f));
            }
        }
    }

    /// Floods one group to its end.
    void finish(Index group) {
        while (floods_[row(group)].growing > 0) {
            for (std::size_t f = 0; f < floods_.size(); ++f) {
                if (group_of(static_cast<Index>(f)) == group) { step(static_cast<Index>(f)); }
            }
        }
    }

    std::vector<Index> groups_of(Index piece) const {
        std::vector<Index> groups;
        for (std::size_t f = 0; f < floods_.size(); ++f) {
            const bool is_group = floods_[f].group == static_cast<Index>(f);
            if (is_group && floods_[f].piece == piece) { groups.push_back(static_cast<Index>(f)); }
        }
        return groups;
    }

    bool is_whole(Index group) const { return floods_[row(group)].growing == 0; }

    /// Of the seeds, ascending.
    std::vector<Index> pieces() const {
        std::vector<Index> pieces;
        for (const auto& [piece, open] : open_) {
            pieces.push_back(piece);
        }
        std::sort(pieces.begin(), pieces.end());
        return pieces;
    }

    template <class Visit>
    void each_copy(Index group, Visit visit) const {
        for (std::size_t f = 0; f < floods_.size(); ++f) {
            if (group_of(static_cast<Index>(f)) != group) { continue; }
            for (Index copy = floods_[f].first; copy >= 0; copy = cutter_.scratch.next_flooded[row(copy)]) {
                visit(copy);
            }
        }
    }

private:
    Index group_of(Index flood) const {
        while (floods_[row(flood)].group != flood) {
            flood = floods_[row(flood)].group;
        }
        return flood;
    }

    /// A piece has one group more or less that can grow.
    void count_open(Index piece, Index change) {
        auto at =
            std::find_if(open_.begin(), open_.end(), [&](const auto& open) { return open.first == piece; });
        if (at == open_.end()) { at = open_.insert(at, {piece, 0}); }
        rivals_ -= std::max(0, at->second - 1);
        at->second += change;
        rivals_ += std::max(0, at->second - 1);
    }

    void step(Index f) {
        const Index copy = floods_[row(f)].next;
        if (copy < 0) { return; }
        for (std::size_t face = 0; face < 4; ++face) {
            each_beside(cutter_, copy, face, [&](Index other) { reach(f, other); });
        }
        floods_[row(f)].next = cutter_.scratch.next_flooded[row(copy)];
        if (floods_[row(f)].next >= 0) { return; }
        Flood& group = floods_[row(group_of(f))];
        if (--group.growing == 0) { count_open(group.piece, -1); }
    }

    void reach(Index f, Index copy) {
        if (reached_.set(copy)) {
            Scratch& scratch = cutter_.scratch;
            scratch.flood_of[row(copy)] = f;
            scratch.next_flooded[row(std::exchange(floods_[row(f)].last, copy))] = copy;
            scratch.next_flooded[row(copy)] = -1;
            return;
        }
        const Index a = group_of(f);
        const Index b = group_of(cutter_.scratch.flood_of[row(copy)]);
        if (a == b) { return; }
        Flood& low = floods_[row(std::min(a, b))];
        Flood& high = floods_[row(std::max(a, b))];
        if (low.growing > 0 && high.growing > 0) { count_open(low.piece, -1); }
        low.growing += high.growing;
        high.group = std::min(a, b);
    }

    Cutter& cutter_;
    Marks& reached_;
    std::vector<Flood> floods_ = {};
    std::vector<std::pair<Index, Index>> open_ = {}; // piece, its groups that can grow
    Index rivals_ = 0;                               // such groups beside the first of each piece
};

Index append_piece(Cutter& cutter, double volume) {
    Piece piece;
    piece.id = static_cast<Index>(cutter.pieces.pieces.size());
    piece.volume = volume;
    cutter.pieces.pieces.push_back(piece);
    return piece.id;
}

struct Part {
    Index group = 0;
    double volume = 0;
};

/// The largest part of a piece keeps its id; others count on.
void assign_ids(Cutter& cutter, Floods& floods, Index id, std::vector<Part>& parts) {
    const auto largest = std::max_element(parts.begin(), parts.end(),
                                          [](const Part& a, const Part& b) { return a.volume < b.volume; });
    for (auto part = parts.begin(); part != parts.end(); ++part) {
        if (part == largest) { continue; }
        floods.finish(part->group);
        const Index fresh = append_piece(cutter, part->volume);
        floods.each_copy(part->group, [&](Index copy) { cutter.pieces.of_copy.edit(row(copy)) = fresh; });
        cutter.pieces.pieces.edit(row(id)).volume -= part->volume;
    }
}

/// What the floods found of a piece: the groups that are whole, and the one that is not is the rest.
std::vector<Part> find_parts_of(const Cutter& cutter, const Floods& floods, Index id) {
    std::vector<Part> parts;
    double rest = cutter.pieces.pieces[row(id)].volume;
    Index open_group = -1;
    for (const Index group : floods.groups_of(id)) {
        if (!floods.is_whole(group)) {
            open_group = group;
            continue;
        }
        Part part = {group, 0};
        floods.each_copy(group, [&](Index copy) { part.volume += volume_of(cutter, copy); });
        rest -= part.volume;
        parts.push_back(part);
    }
    if (open_group >= 0) { parts.push_back({open_group, rest}); }
    return parts;
}

/// Material around a node joins all copies that hang on it.
bool share_a_node(const Tet& a, const Tet& b) {
    return std::any_of(a.begin(), a.end(),
                       [&b](Index node) { return std::find(b.begin(), b.end(), node) != b.end(); });
}

/// Copies on both sides of tears that may have fallen apart, in scratch.stack: where all sides of a tear hang
/// on one node still, as they do about a front, nothing has.
void find_parted(Cutter& cutter) {
    const std::vector<TetFace>& torn = cutter.scratch.torn;
    std::vector<Index>& parted = cutter.scratch.stack;
    parted.clear();
    for (std::size_t i = 0; i < torn.size(); i += 2) {
        const Index a = cutter.material.tet(torn[i].tet).copy;
        const Index b = cutter.material.tet(torn[i + 1].tet).copy;
        if (a == b || share_a_node(cutter.mesh.copy_node[row(a)], cutter.mesh.copy_node[row(b)])) {
            continue;
        }
        parted.push_back(a);
        parted.push_back(b);
    }
    std::sort(parted.begin(), parted.end());
}

} // namespace

void label_pieces(Cutter& cutter) {
    Pieces& known = cutter.pieces;
    std::vector<Index> stack;
    for (std::size_t seed = 0; seed < known.of_copy.size(); ++seed) {
        if (known.of_copy[seed] >= 0) { continue; }
        const Index id = append_piece(cutter, 0);
        known.of_copy.edit(seed) = id;
        stack.assign(1, static_cast<Index>(seed));
        while (!stack.empty()) {
            const Index copy = stack.back();
            stack.pop_back();
            known.pieces.edit(row(id)).volume += volume_of(cutter, copy);
            for (std::size_t face = 0; face < 4; ++face) {
                each_beside(cutter, copy, face, [&](Index other) {
                    if (known.of_copy[row(other)] >= 0) { return; }
                    known.of_copy.edit(row(other)) = id;
                    stack.push_back(other);
                });
            }
        }
    }
}

void split_pieces(Cutter& cutter) {
    find_parted(cutter);
    if (cutter.scratch.stack.empty()) { return; }
    Floods floods(cutter);
    for (const Index copy : cutter.scratch.stack) {
        floods.start_at(copy);
    }
    floods.run();
    for (const Index id : floods.pieces()) {
        std::vector<Part> parts = find_parts_of(cutter, floods, id);
        if (parts.size() > 1) { assign_ids(cutter, floods, id, parts); }
    }
}

std::span<const Piece> update_pieces(Cutter& cutter, std::span<const Vec3f> displacement,
                                     std::span<const std::uint8_t> fixed) {
    Rows<Piece>& pieces = cutter.pieces.pieces;
    for (std::size_t id = 0; id < pieces.size(); ++id) {
        pieces.edit(id) = {.id = static_cast<Index>(id)};
    }
    const SimulationMesh& mesh = cutter.mesh;
    for (std::size_t c = 0; c < mesh.copy_node.size(); ++c) {
        Piece& piece = pieces.edit(row(cutter.pieces.of_copy[c]));
        piece.volume += volume_of(cutter, static_cast<Index>(c));
        piece.mass += mesh.copy_weight[c] * cutter.setup.element_mass[row(mesh.copy_element[c])];
        for (const Index node : mesh.copy_node[c]) {
            piece.held = piece.held || fixed[row(node)] != 0;
        }
        for (Index m = cutter.first_tet[c]; m >= 0; m = cutter.material.tet(m).next) {
            const MaterialTet& tet = cutter.material.tet(m);
            for (const Index v : tet.vertex) {
                piece.centre += (tet.volume / 4) * displaced_position(cutter, v, displacement);
            }
        }
    }
    for (std::size_t id = 0; id < pieces.size(); ++id) {
        Piece& piece = pieces.edit(id);
        piece.centre = (1 / piece.volume) * piece.centre;
    }
    return pieces;
}

Index count_pieces(const Cutter& cutter) { return static_cast<Index>(cutter.pieces.pieces.size()); }

std::span<const Index> piece_of_copy(const Cutter& cutter) { return cutter.pieces.of_copy; }

} // namespace resect
