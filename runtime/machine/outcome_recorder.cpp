#include "runtime/machine/outcome_recorder.hpp"

#include <algorithm>
#include <bit>

#include "core/bytes.hpp"
#include "runtime/recording/outcome_record.hpp"

namespace taktwerk::runtime {

namespace {

/// Longer images are recorded in each cycle, whether they changed or not: memory for the comparison is taken before their length is known.
constexpr std::size_t longest_compared = std::size_t{1} << 16;

}  // namespace

void OutcomeRecorder::begin() {
    now_.resize(std::max(body_.axes.size() * setpoint_bytes, body_.io.outputs().size() * sizeof(std::int64_t)));
    setpoints_.reserve(body_.axes.size() * setpoint_bytes);
    points_.reserve(body_.io.outputs().size() * sizeof(std::int64_t));
    outputs_.reserve(longest_compared);
}

void OutcomeRecorder::record_if_new(RecordChannel channel, Instant at, std::span<const std::byte> bytes,
                                    std::vector<std::byte>& before) noexcept {
    if (std::ranges::equal(bytes, before)) return;
    if (bytes.size() <= before.capacity()) before.assign(bytes.begin(), bytes.end());
    body_.recorder->append(channel, at, bytes);
}

void OutcomeRecorder::record(Instant at, bool armed) noexcept {
    if (armed) {
        const std::span<std::byte> into{now_};
        std::size_t end = 0;
        const auto put = [&](auto value) {
            store_le(into, end, value);
            end += sizeof(value);
        };
        for (const auto& view : body_.views) {
            for (const double number : {view.set_position, view.set_velocity, view.set_acceleration})
                put(std::bit_cast<std::uint64_t>(number));
            put(static_cast<std::uint8_t>(view.state));
        }
        record_if_new(setpoints_channel, at, into.first(end), setpoints_);
        end = 0;
        for (std::size_t i = 0; i < body_.io.outputs().size(); ++i) put(body_.io.output_word(i));
        record_if_new(points_channel, at, into.first(end), points_);
        drives_.serial().record_wishes();
    }
    record_if_new(outputs_channel, at, body_.bus.outputs(), outputs_);
}

}  // namespace taktwerk::runtime
