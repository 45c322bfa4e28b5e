#pragma once
// What is kept over a time without power, as data: by name and type, so that an edited program finds what it still has.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "axes/axis/retained_position.hpp"
#include "fb_library/pins/pin.hpp"
#include "programs/api/program.hpp"

namespace taktwerk::runtime {

/// An axis with an absolute encoder: where its coordinates lie.
struct RetainedAxis {
    std::string name;
    axes::RetainedPosition position;
    axes::Gearing gearing;
};

[[nodiscard]] constexpr std::string_view word(RetainKind kind) noexcept { return kind == RetainKind::retain ? "retain" : "persistent"; }
[[nodiscard]] constexpr std::optional<RetainKind> find_retain_kind(std::string_view text) noexcept {
    for (const auto kind : {RetainKind::retain, RetainKind::persistent})
        if (word(kind) == text) return kind;
    return std::nullopt;
}

/// How long an item has had nobody to claim it: starts of the machine. What an edited program dropped is kept that long, and is found by
/// the one that comes back (a rollback).
using Unclaimed = std::uint16_t;

/// A variable of a program, or a pin of a block of it.
struct KeptValue {
    std::string name;  ///< "program.variable", "program.block.PIN"
    RetainKind kind = RetainKind::retain;
    fb::PinKind type = fb::PinKind::LREAL;
    std::uint64_t bits = 0;  ///< value_type.hpp
    Unclaimed unclaimed = 0;
    bool operator==(const KeptValue&) const = default;
};

/// A whole block, with what is no pin of it: used where it still is the same block, else its pins are.
struct KeptBlock {
    std::string name;  ///< "program.block"
    RetainKind kind = RetainKind::retain;
    std::string type;          ///< "CTU", "TON"
    std::uint64_t layout = 0;  ///< fb::layout_hash of its type
    std::vector<std::byte> bytes;
    Unclaimed unclaimed = 0;
    bool operator==(const KeptBlock&) const = default;
};

/// A parameter that an operator has set.
struct KeptParameter {
    std::string name;  ///< "program.parameter"
    double value = 0;
    double configured = 0;  ///< what the machine file or the program said when it was set: who changes that afterwards wins
    Unclaimed unclaimed = 0;
    bool operator==(const KeptParameter&) const = default;
};

struct Kept {
    std::uint64_t number = 0;  ///< of the writing
    std::vector<RetainedAxis> axes;
    std::vector<KeptValue> values;
    std::vector<KeptBlock> blocks;
    std::vector<KeptParameter> parameters;

    [[nodiscard]] bool empty() const noexcept { return axes.empty() && values.empty() && blocks.empty() && parameters.empty(); }
};

}  // namespace taktwerk::runtime
