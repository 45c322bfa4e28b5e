#pragma once
// What a cycle made of what came in, beside it in the same Recorder: a replay that makes the same of the same shows it here, and one that does
// not has the name and both values. Each record is written only when it differs from the one before. Little-endian, by the cycle thread.
//
//   setpoints  for each axis: f64 position, velocity, acceleration (its unit), u8 AxisState                25 bytes each
//   points     for each output point its raw word as it goes out, i64                                       8 bytes each
//   wish       u16 drive on a serial line, what it is asked for (see record_wish)                          24 bytes
//   outputs    the outputs of the bus' process image
//   call       u8 Call, i64 now ns, u16 index: what was done beside the cycle, where one thread does it all  11 bytes

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ecat/wire/frame.hpp"
#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

inline constexpr RecordChannel setpoints_channel = 15, points_channel = 16, wish_channel = 17, outputs_channel = 18, call_channel = 19;
inline constexpr RecordChannel wire_channel = 21;

/// RecordingInfo::channels of a recording of a machine: the name of each channel at its number. Records of a channel that are arranged otherwise
/// than before need another name here: what was recorded before is refused then (`replay.channels`), and never read wrongly.
[[nodiscard]] inline std::vector<std::string> inbox_channels() {
    return {"",        "tick",       "frame",      "command", "object", "departure", "said",       "modbus_request", "modbus_word",
            "level",   "half_frame", "refused",    "link",    "ring",   "disk",      "setpoints",  "points",         "asked_for",
            "outputs", "call",       "start_file", "wire",    "hook",   "slow",      "task_times", "faults",         "asked"};
}

/// What Machine does outside the cycle, in the order in which the cycle's thread did it.
enum class Call : std::uint8_t {
    start_bus,
    stop_bus,
    arm,        ///< `index`: 1 when it was
    service,    ///< all of Machine::service()
    bus,        ///< Machine::service_bus()
    programs,   ///< Machine::service_programs()
    slow_task,  ///< `index`: of Machine::run_slow_task()
    pump,
};
inline constexpr std::uint8_t call_count = 8;

inline void record_call(Recorder& recorder, Call call, Instant now, std::uint16_t index) noexcept {
    inbox_record::Bytes<11> bytes;
    bytes.put(static_cast<std::uint8_t>(call));
    bytes.put(now);
    bytes.put(index);
    recorder.append(call_channel, now, bytes.all());
}

/// u16 drive, u32 sequence, u8 power, u8 flags (reset, halt, torque), i16 speed, torque, speed limit, i16 up, down ms, u16 session, u16 latch,
/// u16 power turn.
inline void record_wish(Recorder& recorder, Instant at, std::uint16_t drive, const axes::xp200::Wish& wish) noexcept {
    inbox_record::Bytes<24> bytes;
    bytes.put(drive);
    bytes.put(wish.sequence);
    bytes.put(static_cast<std::uint8_t>(wish.power));
    bytes.put(static_cast<std::uint8_t>((wish.reset ? 1u : 0u) | (wish.halt ? 2u : 0u) | (wish.torque_mode ? 4u : 0u)));
    for (const std::int16_t number : {wish.speed, wish.torque, wish.speed_limit, wish.up_ms, wish.down_ms}) bytes.put(number);
    bytes.put(wish.session);
    bytes.put(wish.latch);
    bytes.put(wish.power_turn);
    recorder.append(wish_channel, at, bytes.all());
}

inline constexpr std::size_t setpoint_bytes = 25;

/// Before everything else: u8 whether the bus is a ring, 6 bytes address of the master's interface.
inline void record_wire(Recorder& recorder, const ecat::MacAddress& mac, bool ring) {
    inbox_record::Bytes<7> bytes;
    bytes.put(static_cast<std::uint8_t>(ring ? 1 : 0));
    for (const auto byte : mac) bytes.put(static_cast<std::uint8_t>(byte));
    recorder.append(wire_channel, Instant{}, bytes.all());
}

}  // namespace taktwerk::runtime
