#include "runtime/replay/difference.hpp"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "core/bytes.hpp"
#include "core/process_image.hpp"
#include "runtime/recording/inbox_reader.hpp"

namespace taktwerk::runtime {

namespace {

using Bytes = std::span<const std::byte>;

const std::string& name_of(RecordChannel channel) {
    static const auto names = inbox_channels();
    static const std::string unknown = "?";
    return channel < names.size() ? names[channel] : unknown;
}

void describe_setpoints(Bytes then, Bytes now, const Machine& machine, ReplayDifference& out) {
    const auto& axes = machine.layout().axes;
    for (std::size_t i = 0; i < axes.size() && (i + 1) * setpoint_bytes <= std::min(then.size(), now.size()); ++i) {
        const auto a = read_setpoint(then, i), b = read_setpoint(now, i);
        const auto differs = [&](const char* what, double before, double after, const char* per) {
            if (std::bit_cast<std::uint64_t>(before) == std::bit_cast<std::uint64_t>(after)) return false;
            out.signal = fmt::format("axis {}: {}", axes[i].name, what);
            out.recorded = fmt::format("{} {}{}", before, axes[i].unit, per);
            out.replayed = fmt::format("{} {}{}", after, axes[i].unit, per);
            return true;
        };
        if (differs("set position", a.position, b.position, "") || differs("set velocity", a.velocity, b.velocity, "/s") ||
            differs("set acceleration", a.acceleration, b.acceleration, "/s2"))
            return;
        if (a.state == b.state) continue;
        out.signal = fmt::format("axis {}: state", axes[i].name);
        out.recorded = name(a.state);
        out.replayed = name(b.state);
        return;
    }
}

void describe_points(Bytes then, Bytes now, const Machine& machine, ReplayDifference& out) {
    const auto& names = machine.layout().outputs;
    for (std::size_t i = 0; i < names.size() && (i + 1) * sizeof(std::int64_t) <= std::min(then.size(), now.size()); ++i) {
        const auto a = load_le<std::int64_t>(then, i * sizeof(std::int64_t)), b = load_le<std::int64_t>(now, i * sizeof(std::int64_t));
        if (a == b) continue;
        out.signal = fmt::format("output {}", names[i]);
        out.recorded = std::to_string(a);
        out.replayed = std::to_string(b);
        return;
    }
}

void describe_outputs(Bytes then, Bytes now, const Machine& machine, ReplayDifference& out) {
    std::size_t at = 0;
    while (at < then.size() && at < now.size() && then[at] == now[at]) ++at;
    out.signal = fmt::format("byte {} of the bus' outputs", at);
    if (at == then.size() || at == now.size()) {
        out.recorded = fmt::format("{} bytes", then.size());
        out.replayed = fmt::format("{} bytes", now.size());
        return;
    }
    const auto changed = std::to_integer<unsigned>(then[at] ^ now[at]);
    const std::size_t bit = at * 8 + static_cast<std::size_t>(std::countr_zero(changed));
    const auto place = machine.bus().output_at(bit);
    const auto signal = place ? machine.bus().output(place->slave, place->object, place->sub) : Result<Signal>{Error{}};
    if (!place || !signal) {
        out.recorded = fmt::format("{:02X}h", std::to_integer<unsigned>(then[at]));
        out.replayed = fmt::format("{:02X}h", std::to_integer<unsigned>(now[at]));
        return;
    }
    out.signal = fmt::format("slave '{}' {:04X}h:{:02X}", machine.bus().slave(place->slave).name, place->object, place->sub);
    out.recorded = std::to_string(read_signal(then, *signal));
    out.replayed = std::to_string(read_signal(now, *signal));
}

/// What a record says, where its channel has no words of its own.
std::string digest(const RecordView* record) {
    if (record == nullptr) return "nothing";
    std::string text = fmt::format("{} ({} bytes", name_of(record->channel), record->bytes.size());
    constexpr std::size_t shown = 16;
    for (std::size_t i = 0; i < std::min(shown, record->bytes.size()); ++i)
        text += fmt::format("{}{:02X}", i == 0 ? ": " : " ", std::to_integer<unsigned>(record->bytes[i]));
    return text + (record->bytes.size() > shown ? " ...)" : ")");
}

std::string_view words_of(RecordChannel channel) {
    switch (channel) {
        case departure_channel:
        case refused_channel: return "a frame that the master sent";
        case frame_channel:
        case half_frame_channel: return "a frame that came in";
        case command_channel: return "a command that the cycle took";
        case level_channel: return "a stop that the cycle took";
        case object_channel: return "the answer to a program's object request";
        case sample_channel: return "what a drive on a serial line said";
        case modbus_request_channel:
        case modbus_word_channel: return "what a Modbus device said";
        case wish_channel: return "what a drive on a serial line is asked for";
        case setpoints_channel: return "the axes' set-points";
        case points_channel: return "the output points";
        case outputs_channel: return "the bus' outputs";
        default: return {};
    }
}

}  // namespace

std::string ReplayDifference::text(Instant start) const {
    const auto when = cycle > 0 ? fmt::format("cycle {}", cycle) : std::string("before the machine was up");
    return fmt::format("{}, {:.6f} s: {}: recorded {}, replayed {}", when, to_seconds(at - start), signal, recorded, replayed);
}

void Outcome::take(const RecordView& record) {
    auto* kept = record.channel == setpoints_channel ? &setpoints
                 : record.channel == points_channel  ? &points
                 : record.channel == outputs_channel ? &outputs
                                                     : nullptr;
    if (kept != nullptr) kept->assign(record.bytes.begin(), record.bytes.end());
}

std::optional<ReplayDifference> difference_between(const Outcome& recorded, const Outcome& replayed, const Machine& machine) {
    ReplayDifference out;
    if (recorded.setpoints != replayed.setpoints) describe_setpoints(recorded.setpoints, replayed.setpoints, machine, out);
    if (out.signal.empty() && recorded.points != replayed.points) describe_points(recorded.points, replayed.points, machine, out);
    if (out.signal.empty() && recorded.outputs != replayed.outputs) describe_outputs(recorded.outputs, replayed.outputs, machine, out);
    return out.signal.empty() ? std::nullopt : std::optional{std::move(out)};
}

ReplayDifference difference_between(const RecordView* recorded, const RecordView* replayed) {
    const auto* named = recorded != nullptr ? recorded : replayed;
    const auto words = words_of(named->channel);
    return {0, {}, words.empty() ? name_of(named->channel) : std::string(words), digest(recorded), digest(replayed)};
}

}  // namespace taktwerk::runtime
