#pragma once
// What comes from outside, as bytes of a Recorder: the one recorded inbox (docs/architecture.md). Records stand in the order in which the
// cycle took them: a tick, the frames received in it, the commands drained in it. Little-endian, written by the cycle thread; inbox_reader.hpp
// reads them. What the cycle makes of it: outcome_record.hpp.
//
//   tick     i64 scheduled ns, i64 woken ns, u32 missed                                        20 bytes
//   frame    an Ethernet frame as it came in; half_frame: of one half of a broken ring alone
//   departure  u64 hash of a frame that left, and as its time when that was, as the transport measured it (the servo follows it)
//   refused  u64 hash of a frame that the link did not take
//   link     u8 carrier, when it changes; ring: u8 shape, u16 before, u16 behind the break, u64 opened, u16 whole, when one of them changes
//   level    u8 StopLevel, u16 axis, u64 number (stop_levels.hpp)
//   command  u8 action, u8 owner, u8 mode, u8 flag, u16 axis, u16 index, f64 value, f64 value2,
//            u32 client, u64 sequence, i64 expires ns, u64 after                               52 bytes
//            then, of a measure alone: u8 kind, u16 count, f64 distance, velocity, acceleration, from, to, period   51 bytes
//            then, of a group_jog alone: u8 frame, u16 slots forwards, u16 slots backwards    5 bytes
//   sample   u16 drive on a serial line, what it said (see record_sample)                      74 bytes
//   request  u16 Modbus device, u16 request, u8 fault, u8 exception, u8 ever succeeded, i64 sent ns   15 bytes
//   channel  u16 Modbus device, u16 channel, i64 word: of the request before                   12 bytes
//   object   u16 program, u16 place, u8 outcome, u32 abort code                                9 bytes, then the value read
//   disk     u8 what its thread says of it, when it changes (see DiskSays)
//   hook     u16 program, u8 whether it was stop() and not start(): that has run on a thread of its own, and the cycle takes note of it
//   slow     u16 slower task, whose run on a thread of its own has ended
//   faults   u64 page faults without and u64 with a disk in operation, u8 whether memory is locked; when they change

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "axes/drives/xp200/drive_mailbox.hpp"
#include "core/object_access.hpp"
#include "core/recorder.hpp"
#include "modbus/tcp/device_poller.hpp"
#include "runtime/cycle_tick.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/stop_levels.hpp"

namespace taktwerk::runtime {

inline constexpr RecordChannel tick_channel = 1, frame_channel = 2, command_channel = 3, object_channel = 4, departure_channel = 5,
                               sample_channel = 6, modbus_request_channel = 7, modbus_word_channel = 8, level_channel = 9,
                               half_frame_channel = 10, refused_channel = 11, link_channel = 12, ring_channel = 13, disk_channel = 14,
                               hook_channel = 22, slow_channel = 23, faults_channel = 25;

namespace inbox_record {
template <std::size_t Size>
class Bytes {
public:
    template <class T>
    void put(T value) noexcept {
        auto bits = static_cast<std::uint64_t>(value);
        for (std::size_t i = 0; i < sizeof(T); ++i, bits >>= 8) bytes_[at_++] = static_cast<std::byte>(bits & 0xFF);
    }
    void put(double value) noexcept { put(std::bit_cast<std::uint64_t>(value)); }
    void put(Instant value) noexcept { put(static_cast<std::int64_t>(value.time_since_epoch().count())); }
    [[nodiscard]] std::span<const std::byte> all() const noexcept { return bytes_; }
    [[nodiscard]] std::span<const std::byte> written() const noexcept { return std::span{bytes_}.first(at_); }

private:
    std::array<std::byte, Size> bytes_{};
    std::size_t at_ = 0;
};
}  // namespace inbox_record

inline void record_tick(Recorder& recorder, const CycleTick& tick) noexcept {
    inbox_record::Bytes<20> bytes;
    bytes.put(tick.scheduled);
    bytes.put(tick.woken);
    bytes.put(tick.missed);
    recorder.append(tick_channel, tick.scheduled, bytes.all());
}

inline void record_level(Recorder& recorder, Instant at, StopLevel level, std::uint16_t axis, std::uint64_t number) noexcept {
    inbox_record::Bytes<11> bytes;
    bytes.put(static_cast<std::uint8_t>(level));
    bytes.put(axis);
    bytes.put(number);
    recorder.append(level_channel, at, bytes.all());
}

inline void record_command(Recorder& recorder, Instant at, const OperatorCommand& command) noexcept {
    inbox_record::Bytes<52 + 51> bytes;
    bytes.put(static_cast<std::uint8_t>(command.action));
    bytes.put(static_cast<std::uint8_t>(command.owner));
    bytes.put(static_cast<std::uint8_t>(command.mode));
    bytes.put(static_cast<std::uint8_t>(command.flag));
    bytes.put(command.axis);
    bytes.put(command.index);
    bytes.put(command.value);
    bytes.put(command.value2);
    bytes.put(command.client);
    bytes.put(command.sequence);
    bytes.put(command.expires);
    bytes.put(command.after);
    if (command.action == OperatorAction::measure) {
        const auto& order = command.measure;
        bytes.put(static_cast<std::uint8_t>(order.kind));
        bytes.put(order.count);
        for (const double number : {order.distance, order.velocity, order.acceleration, order.from_hz, order.to_hz, order.period})
            bytes.put(number);
    }
    if (command.action == OperatorAction::group_jog) {
        bytes.put(static_cast<std::uint8_t>(command.group_jog.frame));
        bytes.put(command.group_jog.plus);
        bytes.put(command.group_jog.minus);
    }
    recorder.append(command_channel, at, bytes.written());
}

inline void record_object(Recorder& recorder, Instant at, std::uint16_t program, std::uint16_t place, ObjectOutcome outcome,
                          std::uint32_t abort_code, std::span<const std::byte> value) noexcept {
    inbox_record::Bytes<9 + object_data_limit> bytes;
    bytes.put(program);
    bytes.put(place);
    bytes.put(static_cast<std::uint8_t>(outcome));
    bytes.put(abort_code);
    for (const std::byte b : value.first(std::min(value.size(), object_data_limit))) bytes.put(static_cast<std::uint8_t>(b));
    recorder.append(object_channel, at, bytes.written());
}

/// u16 drive, u32 number, u16 flags (online, saving, running, torque, refused, home, negative and positive limit, released, latch armed, latched, no index), i64 heard ns,
/// i64 sampled ns, i64 position, f64 velocity, f64 torque, u16 alarm, u16 inputs, u16 outputs, u16 epoch, u16 session, u16 latch,
/// i64 latched at, u32 acknowledged, u16 power of.
inline void record_sample(Recorder& recorder, Instant at, std::uint16_t drive, const axes::xp200::Sample& s) noexcept {
    inbox_record::Bytes<74> bytes;
    const unsigned flags = (s.online ? 1u : 0u) | (s.saving ? 2u : 0u) | (s.running ? 4u : 0u) | (s.torque_mode ? 8u : 0u) |
                           (s.setup_refused ? 16u : 0u) | (s.home ? 32u : 0u) | (s.negative_limit ? 64u : 0u) |
                           (s.positive_limit ? 128u : 0u) | (s.released ? 256u : 0u) | (s.latch_armed ? 512u : 0u) |
                           (s.latched ? 1024u : 0u) | (s.no_index ? 2048u : 0u);
    bytes.put(drive);
    bytes.put(s.number);
    bytes.put(static_cast<std::uint16_t>(flags));
    bytes.put(s.heard);
    bytes.put(s.sampled);
    bytes.put(s.position);
    bytes.put(s.velocity);
    bytes.put(s.torque);
    bytes.put(s.alarm);
    bytes.put(s.inputs);
    bytes.put(s.outputs);
    bytes.put(s.epoch);
    bytes.put(s.session);
    bytes.put(s.latch);
    bytes.put(s.latch_at);
    bytes.put(s.acknowledged);
    bytes.put(s.power_of);
    recorder.append(sample_channel, at, bytes.all());
}

inline void record_request(Recorder& recorder, Instant at, std::uint16_t device, std::uint16_t request,
                           const modbus::tcp::DevicePoller::RequestState& state) noexcept {
    inbox_record::Bytes<15> bytes;
    bytes.put(device);
    bytes.put(request);
    bytes.put(static_cast<std::uint8_t>(state.fault.kind));
    bytes.put(state.fault.exception);
    bytes.put(static_cast<std::uint8_t>(state.ever ? 1 : 0));
    bytes.put(state.done);
    recorder.append(modbus_request_channel, at, bytes.all());
}

inline void record_channel(Recorder& recorder, Instant at, std::uint16_t device, std::uint16_t channel, std::int64_t word) noexcept {
    inbox_record::Bytes<12> bytes;
    bytes.put(device);
    bytes.put(channel);
    bytes.put(word);
    recorder.append(modbus_word_channel, at, bytes.all());
}

/// What the thread that writes what is kept says of its disk; the supervisor raises alarms by it.
struct DiskSays {
    bool outdated = false;  ///< RetainKeeper::outdated()
    bool failing = false;   ///< failing() or hangs()
    friend bool operator==(const DiskSays&, const DiskSays&) = default;
};

inline void record_disk(Recorder& recorder, Instant at, const DiskSays& says) noexcept {
    inbox_record::Bytes<1> bytes;
    bytes.put(static_cast<std::uint8_t>((says.outdated ? 1u : 0u) | (says.failing ? 2u : 0u)));
    recorder.append(disk_channel, at, bytes.all());
}

inline void record_hook(Recorder& recorder, Instant at, std::uint16_t program, bool stop) noexcept {
    inbox_record::Bytes<3> bytes;
    bytes.put(program);
    bytes.put(static_cast<std::uint8_t>(stop ? 1 : 0));
    recorder.append(hook_channel, at, bytes.all());
}

inline void record_slow(Recorder& recorder, Instant at, std::uint16_t task) noexcept {
    inbox_record::Bytes<2> bytes;
    bytes.put(task);
    recorder.append(slow_channel, at, bytes.all());
}

/// What a thread beside the cycle saw of the cycle's memory, since the machine operates.
struct FaultsSeen {
    std::uint64_t minor = 0, major = 0;  ///< without and with a disk
    bool memory_locked = false;
    friend bool operator==(const FaultsSeen&, const FaultsSeen&) = default;
};

inline void record_faults(Recorder& recorder, Instant at, const FaultsSeen& seen) noexcept {
    inbox_record::Bytes<17> bytes;
    bytes.put(seen.minor);
    bytes.put(seen.major);
    bytes.put(static_cast<std::uint8_t>(seen.memory_locked ? 1 : 0));
    recorder.append(faults_channel, at, bytes.all());
}

}  // namespace taktwerk::runtime
