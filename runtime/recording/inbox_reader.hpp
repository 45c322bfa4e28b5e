#pragma once
// From the bytes of a record back to what it says (inbox_record.hpp, outcome_record.hpp). Trusts nothing: a record that is too short or too long,
// or names an enumerator that there is not, is nothing. Not for the cycle path.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "axes/drives/xp200/drive_mailbox.hpp"
#include "axes/words/types.hpp"
#include "core/object_access.hpp"
#include "core/recorder.hpp"
#include "ecat/ring/ring_state.hpp"
#include "modbus/tcp/device_poller.hpp"
#include "runtime/cycle_tick.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/recording/outcome_record.hpp"
#include "runtime/recording/task_times_record.hpp"
#include "runtime/stop_levels.hpp"

namespace taktwerk::runtime {

struct LevelRecord {
    StopLevel level = StopLevel::stop;
    std::uint16_t axis = 0;
    std::uint64_t number = 0;
};
struct SampleRecord {
    std::uint16_t drive = 0;
    axes::xp200::Sample sample;  ///< but its revision
};
struct RequestRecord {
    std::uint16_t device = 0, request = 0;
    modbus::tcp::DevicePoller::RequestState state;
};
struct WordRecord {
    std::uint16_t device = 0, channel = 0;
    std::int64_t word = 0;
};
struct CallRecord {
    Call call = Call::service;
    Instant now{};
    std::uint16_t index = 0;
};
struct HookRecord {
    std::uint16_t program = 0;
    bool stop = false;
};
struct SlowRecord {
    std::uint16_t task = 0;
};
struct StartFileRecord {
    std::string name;
    std::span<const std::byte> bytes;  ///< of the record
};
struct WireRecord {
    bool ring = false;
    ecat::MacAddress mac{};
};
struct AxisSetpoint {
    double position = 0, velocity = 0, acceleration = 0;
    axes::AxisState state{};
    friend bool operator==(const AxisSetpoint&, const AxisSetpoint&) = default;
};

[[nodiscard]] std::optional<CycleTick> read_tick(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<OperatorCommand> read_command(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<LevelRecord> read_level(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<SampleRecord> read_sample(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<RequestRecord> read_request(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<WordRecord> read_word(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<std::uint64_t> read_hash(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<bool> read_link(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<ecat::RingState> read_ring(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<DiskSays> read_disk(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<CallRecord> read_call(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<HookRecord> read_hook(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<SlowRecord> read_slow(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<TaskTimesRecord> read_task_times(std::span<const std::byte> bytes);
[[nodiscard]] std::optional<WireRecord> read_wire(std::span<const std::byte> bytes);
/// A name without folders.
[[nodiscard]] std::optional<StartFileRecord> read_start_file(std::span<const std::byte> bytes);
/// `axis`: below bytes.size() / setpoint_bytes.
[[nodiscard]] AxisSetpoint read_setpoint(std::span<const std::byte> bytes, std::size_t axis);

}  // namespace taktwerk::runtime
