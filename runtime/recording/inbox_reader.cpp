#include "runtime/recording/inbox_reader.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>

#include "core/bytes.hpp"

namespace taktwerk::runtime {

namespace {

class Reading {
public:
    explicit Reading(std::span<const std::byte> bytes) : rest_(bytes) {}

    template <class T>
    T take() {
        if (rest_.size() < sizeof(T)) {
            sound_ = false;
            return T{};
        }
        const auto value = load_le<T>(rest_);
        rest_ = rest_.subspan(sizeof(T));
        return value;
    }
    double number() { return std::bit_cast<double>(take<std::uint64_t>()); }
    Instant instant() { return Instant{Duration{take<std::int64_t>()}}; }
    /// Not beyond `last`.
    template <class Enum>
    Enum one_of(Enum last) {
        const auto value = take<std::underlying_type_t<Enum>>();
        if (value > static_cast<std::underlying_type_t<Enum>>(last)) sound_ = false;
        return sound_ ? static_cast<Enum>(value) : Enum{};
    }
    /// All of these bits, and no others.
    template <class T, class... Flag>
    void flags(Flag&... flag) {
        auto bits = take<T>();
        ((flag = (bits & 1u) != 0, bits = static_cast<T>(bits >> 1)), ...);
        if (bits != 0) sound_ = false;
    }
    [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }
    [[nodiscard]] bool sound() const { return sound_; }
    /// All was there, and nothing is left.
    template <class T>
    [[nodiscard]] std::optional<T> ended(T value) const {
        return sound_ && rest_.empty() ? std::optional<T>{std::move(value)} : std::nullopt;
    }

private:
    std::span<const std::byte> rest_;
    bool sound_ = true;
};

}  // namespace

std::optional<CycleTick> read_tick(std::span<const std::byte> bytes) {
    Reading in{bytes};
    CycleTick tick;
    tick.scheduled = in.instant();
    tick.woken = in.instant();
    tick.missed = in.take<std::uint32_t>();
    return in.ended(tick);
}

std::optional<OperatorCommand> read_command(std::span<const std::byte> bytes) {
    Reading in{bytes};
    OperatorCommand command;
    // As it was given: what there is not is the desk's to refuse, now as then.
    command.action = static_cast<OperatorAction>(in.take<std::uint8_t>());
    command.owner = static_cast<axes::Owner>(in.take<std::uint8_t>());
    command.mode = static_cast<Mode>(in.take<std::uint8_t>());
    in.flags<std::uint8_t>(command.flag);
    command.axis = in.take<std::uint16_t>();
    command.index = in.take<std::uint16_t>();
    command.value = in.number();
    command.value2 = in.number();
    command.client = in.take<std::uint32_t>();
    command.sequence = in.take<std::uint64_t>();
    command.expires = in.instant();
    command.after = in.take<std::uint64_t>();
    if (command.action == OperatorAction::measure) {
        auto& order = command.measure;
        order.kind = static_cast<axes::MeasureKind>(in.take<std::uint8_t>());
        order.count = in.take<std::uint16_t>();
        for (double* number : {&order.distance, &order.velocity, &order.acceleration, &order.from_hz, &order.to_hz, &order.period})
            *number = in.number();
    }
    if (command.action == OperatorAction::group_jog) {
        command.group_jog.frame = static_cast<axes::MC_CoordSystem>(in.take<std::uint8_t>());
        command.group_jog.plus = in.take<std::uint16_t>();
        command.group_jog.minus = in.take<std::uint16_t>();
    }
    return in.ended(command);
}

std::optional<LevelRecord> read_level(std::span<const std::byte> bytes) {
    Reading in{bytes};
    LevelRecord record;
    record.level = in.one_of(StopLevel::shutdown);
    record.axis = in.take<std::uint16_t>();
    record.number = in.take<std::uint64_t>();
    return in.ended(record);
}

std::optional<SampleRecord> read_sample(std::span<const std::byte> bytes) {
    Reading in{bytes};
    SampleRecord record;
    auto& s = record.sample;
    record.drive = in.take<std::uint16_t>();
    s.number = in.take<std::uint32_t>();
    in.flags<std::uint16_t>(s.online, s.saving, s.running, s.torque_mode, s.setup_refused, s.home, s.negative_limit, s.positive_limit,
                            s.released, s.latch_armed, s.latched, s.no_index);
    s.heard = in.instant();
    s.sampled = in.instant();
    s.position = in.take<std::int64_t>();
    s.velocity = in.number();
    s.torque = in.number();
    s.alarm = in.take<std::uint16_t>();
    s.inputs = in.take<std::uint16_t>();
    s.outputs = in.take<std::uint16_t>();
    s.epoch = in.take<std::uint16_t>();
    s.session = in.take<std::uint16_t>();
    s.latch = in.take<std::uint16_t>();
    s.latch_at = in.take<std::int64_t>();
    s.acknowledged = in.take<std::uint32_t>();
    s.power_of = in.take<std::uint16_t>();
    return in.ended(record);
}

std::optional<RequestRecord> read_request(std::span<const std::byte> bytes) {
    Reading in{bytes};
    RequestRecord record;
    record.device = in.take<std::uint16_t>();
    record.request = in.take<std::uint16_t>();
    record.state.fault.kind = in.one_of(modbus::tcp::Fault::Kind::bad_answer);
    record.state.fault.exception = in.take<std::uint8_t>();
    in.flags<std::uint8_t>(record.state.ever);
    record.state.done = in.instant();
    return in.ended(record);
}

std::optional<WordRecord> read_word(std::span<const std::byte> bytes) {
    Reading in{bytes};
    WordRecord record;
    record.device = in.take<std::uint16_t>();
    record.channel = in.take<std::uint16_t>();
    record.word = in.take<std::int64_t>();
    return in.ended(record);
}

std::optional<std::uint64_t> read_hash(std::span<const std::byte> bytes) {
    Reading in{bytes};
    const auto hash = in.take<std::uint64_t>();
    return in.ended(hash);
}

std::optional<bool> read_link(std::span<const std::byte> bytes) {
    Reading in{bytes};
    bool up = false;
    in.flags<std::uint8_t>(up);
    return in.ended(up);
}

std::optional<ecat::RingState> read_ring(std::span<const std::byte> bytes) {
    Reading in{bytes};
    ecat::RingState ring;
    ring.shape = in.one_of(ecat::RingShape::exchanged);
    ring.before_break = in.take<std::uint16_t>();
    ring.behind_break = in.take<std::uint16_t>();
    ring.opened = in.take<std::uint64_t>();
    ring.whole = in.take<std::uint16_t>();
    return in.ended(ring);
}

std::optional<DiskSays> read_disk(std::span<const std::byte> bytes) {
    Reading in{bytes};
    DiskSays says;
    in.flags<std::uint8_t>(says.outdated, says.failing);
    return in.ended(says);
}

std::optional<CallRecord> read_call(std::span<const std::byte> bytes) {
    Reading in{bytes};
    CallRecord record;
    record.call = in.one_of(Call::pump);
    record.now = in.instant();
    record.index = in.take<std::uint16_t>();
    return in.ended(record);
}

std::optional<HookRecord> read_hook(std::span<const std::byte> bytes) {
    Reading in{bytes};
    HookRecord record;
    record.program = in.take<std::uint16_t>();
    in.flags<std::uint8_t>(record.stop);
    return in.ended(record);
}

std::optional<SlowRecord> read_slow(std::span<const std::byte> bytes) {
    Reading in{bytes};
    SlowRecord record;
    record.task = in.take<std::uint16_t>();
    return in.ended(record);
}

std::optional<TaskTimesRecord> read_task_times(std::span<const std::byte> bytes) {
    Reading in{bytes};
    TaskTimesRecord record;
    record.task = in.take<std::uint16_t>();
    record.overruns = in.take<std::uint64_t>();
    for (auto* time :
         {&record.run.last, &record.run.minimum, &record.run.maximum, &record.run.mean, &record.lateness, &record.lateness_max})
        *time = Duration{in.take<std::int64_t>()};
    return in.ended(record);
}

std::optional<FaultsSeen> read_faults(std::span<const std::byte> bytes) {
    Reading in{bytes};
    FaultsSeen seen;
    seen.minor = in.take<std::uint64_t>();
    seen.major = in.take<std::uint64_t>();
    in.flags<std::uint8_t>(seen.memory_locked);
    return in.ended(seen);
}

std::optional<WireRecord> read_wire(std::span<const std::byte> bytes) {
    Reading in{bytes};
    WireRecord record;
    in.flags<std::uint8_t>(record.ring);
    for (auto& byte : record.mac) byte = in.take<std::uint8_t>();
    return in.ended(record);
}

std::optional<StartFileRecord> read_start_file(std::span<const std::byte> bytes) {
    Reading in{bytes};
    const auto length = in.take<std::uint16_t>();
    if (!in.sound() || in.rest().size() < length || length == 0) return std::nullopt;
    StartFileRecord record;
    for (const std::byte b : in.rest().first(length)) record.name += static_cast<char>(b);
    const bool plain = std::ranges::all_of(
        record.name, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-'; });
    if (!plain || record.name.front() == '.') return std::nullopt;
    record.bytes = in.rest().subspan(length);
    return record;
}

AxisSetpoint read_setpoint(std::span<const std::byte> bytes, std::size_t axis) {
    Reading in{bytes.subspan(axis * setpoint_bytes, setpoint_bytes)};
    AxisSetpoint setpoint;
    setpoint.position = in.number();
    setpoint.velocity = in.number();
    setpoint.acceleration = in.number();
    setpoint.state = static_cast<axes::AxisState>(in.take<std::uint8_t>());
    return setpoint;
}

}  // namespace taktwerk::runtime
