// SPDX-License-Identifier: Apache-2.0
#include "io/number_type.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "base/assert.hpp"

namespace resect {

namespace {

struct NamedType {
    std::string_view name = {};
    NumberType type = {};
};

constexpr NumberKind real = NumberKind::real;
constexpr NumberKind whole = NumberKind::signed_integer;
constexpr NumberKind counting = NumberKind::unsigned_integer;

constexpr NamedType named_types[] = {
    {"Float32", {real, 4}},
    {"Float64", {real, 8}},
    {"Int8", {whole, 1}},
    {"Int16", {whole, 2}},
    {"Int32", {whole, 4}},
    {"Int64", {whole, 8}},
    {"UInt8", {counting, 1}},
    {"UInt16", {counting, 2}},
    {"UInt32", {counting, 4}},
    {"UInt64", {counting, 8}},
    {"float", {real, 4}},
    {"double", {real, 8}},
    {"char", {whole, 1}},
    {"short", {whole, 2}},
    {"int", {whole, 4}},
    {"long", {whole, 8}},
    {"unsigned_char", {counting, 1}},
    {"unsigned_short", {counting, 2}},
    {"unsigned_int", {counting, 4}},
    {"unsigned_long", {counting, 8}},
    {"vtktypeint64", {whole, 8}},
    {"vtktypeuint64", {counting, 8}},
    {"vtkidtype", {whole, 4}}, // legacy files narrow it
};

template <class Number>
Number number_at(const char* bytes, bool big_endian) {
    std::array<char, sizeof(Number)> ordered = {};
    std::copy_n(bytes, ordered.size(), ordered.begin());
    if (big_endian) { std::reverse(ordered.begin(), ordered.end()); }
    return std::bit_cast<Number>(ordered);
}

template <class Number, class Out>
std::vector<Out> decode_as(std::string_view bytes, bool big_endian) {
    std::vector<Out> values(bytes.size() / sizeof(Number));
    for (std::size_t i = 0; i < values.size(); ++i) {
        // NOLINTNEXTLINE(bugprone-signed-char-misuse): Int8 is a number here, not a character.
        values[i] = static_cast<Out>(number_at<Number>(bytes.data() + i * sizeof(Number), big_endian));
    }
    return values;
}

template <class Out>
std::vector<Out> decode_whole(std::string_view bytes, NumberType type, bool big_endian) {
    const bool is_signed = type.kind == whole;
    switch (type.size) {
    case 1:
        return is_signed ? decode_as<std::int8_t, Out>(bytes, big_endian)
                         : decode_as<std::uint8_t, Out>(bytes, big_endian);
    case 2:
        return is_signed ? decode_as<std::int16_t, Out>(bytes, big_endian)
                         : decode_as<std::uint16_t, Out>(bytes, big_endian);
    case 4:
        return is_signed ? decode_as<std::int32_t, Out>(bytes, big_endian)
                         : decode_as<std::uint32_t, Out>(bytes, big_endian);
    default:
        return is_signed ? decode_as<std::int64_t, Out>(bytes, big_endian)
                         : decode_as<std::uint64_t, Out>(bytes, big_endian);
    }
}

} // namespace

std::optional<NumberType> find_number_type(std::string_view name) {
    for (const NamedType& named : named_types) {
        if (named.name == name) { return named.type; }
    }
    return std::nullopt;
}

std::vector<double> decode_reals(std::string_view bytes, NumberType type, bool big_endian) {
    if (type.kind != real) { return decode_whole<double>(bytes, type, big_endian); }
    return type.size == 4 ? decode_as<float, double>(bytes, big_endian)
                          : decode_as<double, double>(bytes, big_endian);
}

std::vector<std::int64_t> decode_integers(std::string_view bytes, NumberType type, bool big_endian) {
    RESECT_ASSERT(type.kind != real);
    return decode_whole<std::int64_t>(bytes, type, big_endian);
}

} // namespace resect
