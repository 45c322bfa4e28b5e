#include "hmi_bridge/gateway/measurements.hpp"

#include <fmt/format.h>

namespace taktwerk::hmi {

using axes::ExcitationRefusal;

namespace {

constexpr std::size_t most_samples = 2'000'000;  ///< of all axes together; more than the longest plan at a cycle of 250 us

Error refused(const std::string& axis, std::string what, std::string remedy) {
    return {"measure.refused", "axis " + axis, std::move(what), std::move(remedy)};
}

/// Why there is no path, and what to give instead.
Error explain(const axes::ExcitationPlan& plan, const std::string& axis, const std::string& unit) {
    const auto& bounds = plan.bounds();
    const auto beyond = [&](double limit, std::string_view which) {
        return refused(
            axis,
            fmt::format("its path goes from {:g} to {:g} {unit}, and with {:g} {unit} for a stop it needs {:g} {unit} from where it "
                        "stands ({:g} {unit}); the {} limit {:g} {unit} leaves {:g} {unit}",
                        plan.lowest(), plan.highest(), plan.margin(), plan.needed(), bounds.start, which, limit, plan.room(),
                        fmt::arg("unit", unit)),
            "Give a smaller distance or velocity, the other direction, or move the axis away from its limit first.");
    };
    switch (plan.refusal()) {
        case ExcitationRefusal::below_limit: return beyond(bounds.position_min, "lower software");
        case ExcitationRefusal::above_limit: return beyond(bounds.position_max, "upper software");
        case ExcitationRefusal::too_short:
            return refused(
                axis,
                fmt::format("at {:g} {unit}/s and {:g} {unit}/s2 nothing of {:g} {unit} is left to measure", plan.order().velocity,
                            plan.order().acceleration, std::abs(plan.order().distance), fmt::arg("unit", unit)),
                fmt::format("Give a distance of {:g} {} or more, or a lower velocity.", plan.needed(), unit));
        case ExcitationRefusal::too_long:
            return refused(axis,
                           fmt::format("it would take {:.0f} s; the longest is {:.0f} s", plan.duration(), axes::ExcitationPlan::longest),
                           "Give a shorter distance, a smaller count, or a higher lowest frequency.");
        case ExcitationRefusal::frequency:
            return refused(axis, fmt::format("{:g} to {:g} Hz is no sweep of this machine", plan.order().from_hz, plan.order().to_hz),
                           fmt::format("Give a lower and a higher frequency, at most {:g} Hz (a fifth of the cycle's).", plan.needed()));
        case ExcitationRefusal::too_many:
            return refused(axis, fmt::format("a count of {} is too much", plan.order().count),
                           fmt::format("Give at most {:g}.", plan.needed()));
        case ExcitationRefusal::no_velocity:
            return refused(axis, "the override of its velocity is 0", "Set the override to the part of the velocity that it may have.");
        case ExcitationRefusal::short_period:
            return refused(axis,
                           fmt::format("a period of {:g} {unit} passes unseen at {:g} {unit}/s", plan.order().period, plan.order().velocity,
                                       fmt::arg("unit", unit)),
                           fmt::format("Give a period of {:g} {} or more, or a lower velocity.", plan.needed(), unit));
        case ExcitationRefusal::no_kind:
            return refused(axis, "nothing says what is to be measured",
                           "Give \"kind\": step, ramp, friction, sweep, following or cogging.");
        case ExcitationRefusal::bad_number:
        case ExcitationRefusal::none: break;
    }
    return refused(axis, "a number of it is negative, not finite, or next to nothing",
                   "Give numbers of 0 or more; only a distance may be negative.");
}

}  // namespace

Result<axes::ExcitationPlan> Measurements::plan(std::uint16_t axis, const axes::MeasureOrder& order,
                                                const runtime::Snapshot& snapshot) const {
    const auto& layout = machine_.layout();
    const auto* config = machine_.axis_config(axis);
    if (axis >= layout.axes.size() || axis >= snapshot.axes.size() || config == nullptr)
        return Error{"measure.unknown", "", "this machine has no such axis", "Look at the names it has (taktwerk monitor)."};
    const axes::ExcitationPlan plan(order, runtime::measure_bounds(*config, snapshot.axes[axis], snapshot.mode, layout.cycle));
    if (plan.refusal() != ExcitationRefusal::none) return explain(plan, layout.axes[axis].name, layout.axes[axis].unit);
    return plan;
}

void Measurements::step(const runtime::Snapshot* snapshot) {
    axes::MeasureSample sample;
    while (machine_.next_measure_sample(sample)) {
        if (snapshot == nullptr) continue;
        if (sample.run != filling_) {  // the snapshot is at least as new as its first sample
            filling_ = sample.run;
            axis_ = snapshot->measure.run == sample.run ? snapshot->measure.axis : 0xFFFF;
            if (axis_ != 0xFFFF) begin_run(snapshot->measure);
        }
        if (axis_ == 0xFFFF) continue;
        auto& kept = runs_[axis_].samples.samples;
        if (kept.size() < kept.capacity()) kept.push_back(sample);
    }
    if (snapshot == nullptr || axis_ == 0xFFFF || snapshot->measure.run != filling_) return;
    runs_[axis_].state = snapshot->measure;
}

/// Older runs make room for it, the oldest first; the room for its samples is taken at once, that nothing is moved on the way.
void Measurements::begin_run(const runtime::MeasureState& state) {
    constexpr double longer = 1.5;  // a plan knows its time only nearly
    const auto expected = std::min(static_cast<double>(most_samples), state.plan.duration() * longer / state.plan.bounds().cycle + 1000);
    runs_[state.axis] = {state, {state.plan, {}}, false};
    auto room = static_cast<std::size_t>(expected);
    for (const auto& [axis, run] : runs_) room += run.samples.samples.capacity();
    while (room > most_samples) {
        Run* oldest = nullptr;
        for (auto& [axis, run] : runs_)
            if (run.samples.samples.capacity() > 0 && (oldest == nullptr || run.state.run < oldest->state.run)) oldest = &run;
        if (oldest == nullptr) break;
        room -= oldest->samples.samples.capacity();
        oldest->samples.samples = {};
        oldest->forgotten = true;
    }
    runs_[state.axis].samples.samples.reserve(static_cast<std::size_t>(expected));
}

const Measurements::Run* Measurements::newest(std::uint16_t axis) const {
    const auto found = runs_.find(axis);
    return found == runs_.end() ? nullptr : &found->second;
}

}  // namespace taktwerk::hmi
