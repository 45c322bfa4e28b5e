#pragma once
// A message of any type, read with bounds: counts and lengths are held against the bytes that are left before anything is made of them. lcm-gen's decoders
// trust both and read beyond the message, or throw (measured: docs/lcm.md). Not real-time.

#include <cstddef>
#include <optional>
#include <span>

#include <nlohmann/json_fwd.hpp>

#include "core/result.hpp"
#include "hmi_bridge/lcm_types/type_catalog.hpp"

namespace taktwerk::hmi {

inline constexpr std::size_t longest_message = std::size_t{4} << 20;  ///< that is looked into
inline constexpr std::size_t most_values = 1'000'000;                 ///< likewise

/// Nothing where it is shorter than one.
[[nodiscard]] std::optional<std::uint64_t> fingerprint_of(std::span<const std::byte> message) noexcept;

/// The message is one of this type, whole and with nothing behind it: then lcm-gen's decoder may have it. Errors: lcm.not_this_type, lcm.bad_message.
[[nodiscard]] Result<void> check_message(const TypeCatalog& catalog, const LcmType& type, std::span<const std::byte> message);

/// The same, as an object: its fields in their order; a `byte` array as a text where it is one, padded with zeros, else as hexadecimal digits. Numbers that
/// JSON cannot hold stay in it as they are.
[[nodiscard]] Result<nlohmann::ordered_json> read_message(const TypeCatalog& catalog, const LcmType& type,
                                                          std::span<const std::byte> message);

}  // namespace taktwerk::hmi
