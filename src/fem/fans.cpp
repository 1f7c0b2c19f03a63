// SPDX-License-Identifier: Apache-2.0
#include "fem/fans.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "base/index.hpp"

namespace resect {
namespace {

/// A tet as its edge ab sees it: it lies between faces abc and abd, and (a, b, c, d) is positive.
struct Link {
    Index a, b, c, d;
    Index tet;
};

struct EdgeRow {
    Index first = 0, count = 0; // rows of links
    std::uint32_t rank = 0; // by length, in steps of a part in a thousand, so that rounding does not shuffle
                            // edges of equal length
};

/// The pair (from, to) of corners in the order that makes (edge, from, to) a positive tet.
constexpr int across[6][2] = {{2, 3}, {3, 1}, {1, 2}, {0, 3}, {2, 0}, {0, 1}};

Link make_link(const Tet& tet, Index row_of_tet, std::size_t edge) {
    const auto corner = [&](int k) { return tet[row(k)]; };
    Link link = {corner(edge_corners[edge][0]), corner(edge_corners[edge][1]), corner(across[edge][0]),
                 corner(across[edge][1]), row_of_tet};
    if (link.a > link.b) {
        std::swap(link.a, link.b);
        std::swap(link.c, link.d);
    }
    return link;
}

/// By a, then b, then tet.
std::vector<Link> find_links(std::span<const Tet> tets) {
    struct Key {
        std::uint64_t edge;
        Index tet, of_tet;
    };
    std::vector<Key> keys;
    keys.reserve(6 * tets.size());
    for (std::size_t t = 0; t < tets.size(); ++t) {
        for (std::size_t edge = 0; edge < 6; ++edge) {
            const auto [low, high] =
                std::minmax(tets[t][row(edge_corners[edge][0])], tets[t][row(edge_corners[edge][1])]);
            keys.push_back({std::uint64_t{row(low)} << 32U | row(high), static_cast<Index>(t),
                            static_cast<Index>(edge)});
        }
    }
    std::sort(keys.begin(), keys.end(),
              [](const Key& p, const Key& q) { return p.edge != q.edge ? p.edge < q.edge : p.tet < q.tet; });
    std::vector<Link> links;
    links.reserve(keys.size());
    for (const Key& key : keys) {
        links.push_back(make_link(tets[row(key.tet)], key.tet, row(key.of_tet)));
    }
    return links;
}

/// Long edges first.
std::vector<EdgeRow> find_edges(std::span<const Link> links, std::span<const Vec3f> at) {
    std::vector<EdgeRow> edges;
    for (std::size_t i = 0; i < links.size(); ++i) {
        const Link& link = links[i];
        if (i == 0 || link.a != links[i - 1].a || link.b != links[i - 1].b) {
            const Vec3f along = at[row(link.b)] - at[row(link.a)];
            // The exponent and ten bits of the mantissa.
            edges.push_back(
                {static_cast<Index>(i), 0, std::bit_cast<std::uint32_t>(dot(along, along)) >> 13U});
        }
        ++edges.back().count;
    }
    std::stable_sort(edges.begin(), edges.end(),
                     [](const EdgeRow& p, const EdgeRow& q) { return p.rank > q.rank; });
    return edges;
}

class Cover {
public:
    Cover(std::span<const Tet> tets, std::span<const Vec3f> at)
        : links_(find_links(tets)), edges_(find_edges(links_, at)), taken_(tets.size(), 0) {}

    std::vector<Fan> run() {
        Index longest = 1;
        for (const EdgeRow& edge : edges_) {
            longest = std::max(longest, edge.count);
        }
        for (Index length = std::min<Index>(longest, fan_longest); length >= 1; --length) {
            for (EdgeRow& edge : edges_) {
                take_fans(edge, length);
            }
        }
        std::sort(fans_.begin(), fans_.end(), [](const Fan& p, const Fan& q) {
            return *std::min_element(p.tet.begin(), p.tet.begin() + p.length) <
                   *std::min_element(q.tet.begin(), q.tet.begin() + q.length);
        });
        return std::move(fans_);
    }

private:
    /// Takes what lies free round the edge in fans of at least `length`.
    void take_fans(EdgeRow& edge, Index length) {
        if (edge.count < length) { return; }
        free_.clear();
        const auto begin = links_.begin() + edge.first;
        const auto kept = std::remove_if(begin, begin + edge.count,
                                         [&](const Link& link) { return taken_[row(link.tet)] != 0; });
        edge.count = static_cast<Index>(kept - begin);
        if (edge.count < length) { return; }
        free_.assign(begin, kept);
        while (!free_.empty()) {
            const std::vector<Link> chain = take_chain();
            for (std::size_t at = 0; at + row(length) <= chain.size(); at += row(fan_longest)) {
                add_fan(std::span(chain).subspan(at, std::min(chain.size() - at, row(fan_longest))));
            }
        }
    }

    /// From a link without a predecessor, or all round.
    std::vector<Link> take_chain() {
        const auto has_predecessor = [&](const Link& link) {
            return std::any_of(free_.begin(), free_.end(),
                               [&](const Link& other) { return other.d == link.c; });
        };
        auto next = std::find_if_not(free_.begin(), free_.end(), has_predecessor);
        if (next == free_.end()) { next = free_.begin(); }
        std::vector<Link> chain;
        while (next != free_.end()) {
            chain.push_back(*next);
            free_.erase(next);
            next = std::find_if(free_.begin(), free_.end(),
                                [&](const Link& link) { return link.c == chain.back().d; });
        }
        return chain;
    }

    void add_fan(std::span<const Link> chain) {
        Fan fan;
        fan.length = static_cast<Index>(chain.size());
        fan.closed = fan.length > 2 && chain.back().d == chain.front().c;
        fan.node[0] = chain.front().a;
        fan.node[1] = chain.front().b;
        fan.node[2] = chain.front().c;
        for (std::size_t j = 0; j < chain.size(); ++j) {
            fan.node[3 + j] = chain[j].d;
            fan.tet[j] = chain[j].tet;
            taken_[row(chain[j].tet)] = 1;
        }
        fans_.push_back(fan);
    }

    std::vector<Link> links_;
    std::vector<EdgeRow> edges_;
    std::vector<std::uint8_t> taken_; // [tet]
    std::vector<Link> free_;
    std::vector<Fan> fans_;
};

} // namespace

std::vector<Fan> cover_with_fans(std::span<const Tet> tets, std::span<const Vec3f> at) {
    return Cover(tets, at).run();
}

} // namespace resect
