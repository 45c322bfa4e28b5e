#pragma once
// whole_state_v5_t as bytes, and back: of a stranger's bytes only what is whole gets through. Not real-time.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/result.hpp"
#include "taktwerk_lcm/whole_state_v5_t.hpp"

namespace taktwerk::hmi {

/// The encoded message with its `check`; empty where it cannot be encoded. Valid until `buffer` changes.
[[nodiscard]] std::span<const std::byte> write_whole_state(const taktwerk_lcm::whole_state_v5_t& state, std::vector<std::byte>& buffer);

/// What tells one message from another, read without looking at the rest.
struct WholeHead {
    std::int64_t run = 0, publication = 0;
};
/// Nothing: another type, another protocol, or the `check` is not that of these bytes.
[[nodiscard]] std::optional<WholeHead> head_of_whole_state(std::span<const std::byte> message) noexcept;

/// Errors: lcm.not_this_type, lcm.bad_message (also: its check).
[[nodiscard]] Result<taktwerk_lcm::whole_state_v5_t> read_whole_state(std::span<const std::byte> message);

}  // namespace taktwerk::hmi
