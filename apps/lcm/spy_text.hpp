#pragma once
// What `taktwerk lcm spy` shows. Text from data.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "apps/lcm/channel_book.hpp"
#include "apps/terminal/text_table.hpp"
#include "hmi_bridge/lcm_types/type_catalog.hpp"

namespace taktwerk::apps {

/// A row a channel, then a line a machine. `utime`: now, us since 1970.
[[nodiscard]] std::string channels_text(const ChannelBook& book, std::int64_t utime, Colours colours);
[[nodiscard]] std::string channels_json(const ChannelBook& book, std::int64_t utime);

/// The channel, its type, and a line a field; what cannot be read as hexadecimal digits, with why.
[[nodiscard]] std::string message_text(const hmi::TypeCatalog& catalog, std::string_view channel, std::span<const std::byte> message);
/// {"channel":...,"type":...,"utime":received,"bytes":n,"message":{...}}, or "hex" and "problem".
[[nodiscard]] std::string message_json(const hmi::TypeCatalog& catalog, std::string_view channel, std::span<const std::byte> message,
                                       std::int64_t utime);

/// Messages of one channel that stand side by side have different ones: the axis, the first of several points.
[[nodiscard]] std::string part_of(const hmi::TypeCatalog& catalog, std::span<const std::byte> message);

}  // namespace taktwerk::apps
