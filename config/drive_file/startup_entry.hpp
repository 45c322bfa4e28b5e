#pragma once
// One entry of a start-up list as written, and as the bus wants it.

#include <optional>
#include <vector>

#include "config/reading/field_table.hpp"
#include "ecat/bus_config.hpp"

namespace taktwerk::config {

struct StartupEntry {
    ecat::Transition at = ecat::Transition::PreopToSafeop;
    ObjectAddress object;
    std::optional<ecat::DataType> type;
    std::int64_t value = 0;
    std::optional<bool> verify;
    bool if_changed = false;
    std::string comment;
    Position where;
};

[[nodiscard]] Table<StartupEntry> startup_table();
[[nodiscard]] Codec<ecat::DataType> data_type();

/// With what the dictionary knows: type where none is given, no read-back of write-only objects. Reports what does not fit
/// (config.startup_*). `file` is where the entry stands.
[[nodiscard]] std::vector<ecat::StartupSdo> resolve_startup(Reader& reader, const std::string& file,
                                                            const std::vector<StartupEntry>& entries,
                                                            const ecat::DeviceDescription& device);

[[nodiscard]] const ecat::ObjectEntry* find_object(const ecat::DeviceDescription& device, std::uint16_t index, std::uint8_t sub) noexcept;

}  // namespace taktwerk::config
