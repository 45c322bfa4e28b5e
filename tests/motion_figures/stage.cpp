#include "tests/motion_figures/stage.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "axes/axis/plan_order.hpp"

namespace taktwerk::figures {
namespace {

double value_of(const axes::AxisView& view, const axes::test::FakeDrive& drive, Quantity quantity) {
    switch (quantity) {
        case Quantity::position: return view.set_position;
        case Quantity::velocity: return view.set_velocity;
        case Quantity::acceleration: return view.set_acceleration;
        case Quantity::actual_position: return view.actual_position;
        case Quantity::actual_velocity: return view.actual_velocity;
        case Quantity::actual_torque: return view.actual_torque;
        case Quantity::given_torque: return drive.last.torque;
    }
    return 0;
}

}  // namespace

axes::AxisConfig Stage::linear(const std::string& name) {
    axes::AxisConfig config;
    config.name = name;
    config.gearing = {.counts_per_revolution = 100000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 10};
    config.limits = {.velocity = 200, .acceleration = 1000, .deceleration = 1000, .jerk = 20000};
    config.require_homed = false;
    return config;
}

Stage::Stage(const std::vector<axes::AxisConfig>& configs) {
    axes_.reserve(configs.size());
    for (std::size_t i = 0; i < configs.size(); ++i) {
        drives_.emplace_back(period);
        axes_.emplace_back(configs[i], drives_.back(), period, static_cast<std::uint16_t>(i));
        oracles_.emplace_back(configs[i], period);
    }
    bind();
    requests_ = axes::DirectRequests{axes_};
    powers_.resize(axes_.size());
    for (std::size_t i = 0; i < powers_.size(); ++i) {
        powers_[i].Axis = ref(static_cast<std::uint16_t>(i));
        powers_[i].Enable = true;
    }
    for (int i = 0; i < 1000; ++i) cycle();
    for (const auto& power : powers_)
        if (!power.Status) throw std::runtime_error("the axes of a figure did not get power");
}

/// Axes take the room for their tables when they are bound.
void Stage::bind() {
    for (auto& axis : axes_) axis.bind({axes_.data(), axes_.size(), &tables_, {}});
}

axes::TimeTableRef Stage::time_table(const std::vector<axes::TimePoint>& rows) {
    const auto table = tables_.add_time_table(rows);
    bind();
    return table;
}

void Stage::bar(const std::string& label, const bool& value) {
    bars_.push_back({label, std::max(blocks_ - 1, 0), [&value] { return value; }, {}});
}

void Stage::show(const std::string& quantity, const std::string& unit, double height, const std::vector<Shown>& curves) {
    Panel panel{quantity, unit, height, {}};
    for (const auto& curve : curves) panel.curves.push_back({curve.label, curve.ink, {}});
    figure_.panels.push_back(std::move(panel));
    shown_.push_back(curves);
}

void Stage::cycle() {
    now_ += period;
    for (auto& axis : axes_) {
        axis.update(now_);
        axis.supervise(now_);
    }
    seen_.clear();
    for (const auto& axis : axes_) seen_.push_back(axis.view());
    fb::MotionContext ctx;
    ctx.now = now_;
    ctx.period = period;
    ctx.cycle = ++cycle_;
    ctx.axes = seen_;
    ctx.requests = &requests_;
    ctx.tables = &tables_;
    for (auto& power : powers_) power(ctx);
    if (before) before(ctx);
    for (const auto& call : calls_) call(ctx);
    axes::plan_axes(axes_, now_, period);
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        axes_[i].encode(now_);
        oracles_[i].observe(axes_[i].view(), axes_[i].drive_command(), axes_[i].config().limits);
        if (!oracles_[i].clean()) throw std::runtime_error("a figure shows what must not be: " + oracles_[i].report());
    }
}

void Stage::note() {
    int owner = -1;
    for (const auto& control : controls_)
        if (*control.active || (control.held != nullptr && *control.held)) owner = control.block;
    figure_.owner.push_back(owner);
    figure_.state.emplace_back(axes::name(view().state));
    for (auto& bar : bars_) bar.on.push_back(bar.value());
    for (std::size_t p = 0; p < shown_.size(); ++p)
        for (std::size_t c = 0; c < shown_[p].size(); ++c) {
            const auto& [axis, quantity, ink, label, value] = shown_[p][c];
            figure_.panels[p].curves[c].values.push_back(value != nullptr ? *value : value_of(view(axis), drives_[axis], quantity));
        }
}

void Stage::scan() {
    if (shown_.empty()) {
        show("velocity", "mm/s", 90, {{0, Quantity::velocity}});
        show("position", "mm", 90, {{0, Quantity::position}});
    }
    cycle();
    note();
}

void Stage::run_until(const std::function<bool()>& condition, Duration most) {
    for (Duration t{}; t <= most; t += period) {
        scan();
        if (condition()) return;
    }
    throw std::runtime_error(fmt::format("what a figure waited for did not happen; the axis is in {}", axes::name(view().state)));
}

Figure Stage::figure(const std::string& name) {
    figure_.name = name;
    figure_.period = to_seconds(period);
    for (const auto& bar : bars_) figure_.traces.push_back({bar.label, bar.block, bar.on});
    return figure_;
}

}  // namespace taktwerk::figures
