#pragma once
// What people ask of the bus beside the cycle, as bytes of a Recorder: it stands behind the service in which it was taken (outcome_record.hpp, `call`).
//
//   asked   u8 kind, u16 axis, u16 index, u8 sub, u8 service, then the value to write    7 bytes and more

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "axes/port/drive_port.hpp"
#include "core/recorder.hpp"
#include "core/time.hpp"

namespace taktwerk::runtime {

inline constexpr RecordChannel asked_channel = 26;

enum class AskedKind : std::uint8_t {
    read,     ///< a parameter
    write,    ///< a parameter
    service,  ///< of a drive (axes::DriveService)
    ports,    ///< how the ports of the slaves stand (BusLook); of no axis
};

struct AskedRecord {
    AskedKind kind = AskedKind::read;
    std::uint16_t axis = 0;
    axes::ParameterAddress address{};
    axes::DriveService service = axes::DriveService::clear_multi_turn;
    std::vector<std::byte> value{};
};

/// Longer values are cut; no parameter is so long.
inline constexpr std::size_t most_asked_bytes = 1024;

void record_asked(Recorder& recorder, Instant at, const AskedRecord& asked);
[[nodiscard]] std::optional<AskedRecord> read_asked(std::span<const std::byte> bytes);

}  // namespace taktwerk::runtime
