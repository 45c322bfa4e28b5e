#include "tests/motion_figures/group_stage.hpp"

namespace taktwerk::figures {

axes::AxisConfig GroupStage::linear(const std::string& name) {
    return axes::test::group_axis(name, {.velocity = 200, .acceleration = 1000, .deceleration = 1000, .jerk = 10000});
}

GroupStage::GroupStage()
    : GroupStage({linear("x"), linear("y")}, axes::test::arm_of({.arm = axes::CartesianAxes{.linear = {true, true, false}}})) {}

GroupStage::GroupStage(const std::vector<axes::AxisConfig>& configs, axes::test::Arm arm)
    : plc_(configs, axes::test::GroupRig::all_of(configs, std::move(arm))) {
    fb::MC_GroupEnable enable;
    if (plc_.carry_out(enable) != fb::ErrorId::none) throw std::runtime_error("the group of a figure could not be enabled");
    plc_.program = [this](const fb::MotionContext& ctx) {
        for (const auto& call : calls_) call(ctx);
    };
}

void GroupStage::show(const std::string& quantity, const std::string& unit, double height, std::vector<Shown> curves) {
    Panel panel{quantity, unit, height, {}};
    for (const auto& curve : curves) panel.curves.push_back({curve.label, curve.ink, {}});
    figure_.panels.push_back(std::move(panel));
    shown_.push_back(std::move(curves));
}

void GroupStage::scan() {
    plc_.scan();
    int owner = -1;
    for (const auto& [block, active] : actives_)
        if (*active) owner = block;
    figure_.owner.push_back(owner);
    figure_.state.emplace_back(axes::name(view().state));
    for (auto& bar : bars_) bar.on.push_back(*bar.value);
    for (std::size_t p = 0; p < shown_.size(); ++p)
        for (std::size_t c = 0; c < shown_[p].size(); ++c) figure_.panels[p].curves[c].values.push_back(shown_[p][c].value(view()));
    if (figure_.way_height > 0) figure_.way.push_back({view().tool_set[0], view().tool_set[1]});
}

void GroupStage::run(Duration time) {
    for (Duration t{}; t < time; t += axes::test::GroupRig::cycle) scan();
}

void GroupStage::run_until(const std::function<bool()>& condition, Duration most) {
    for (Duration t{}; t <= most; t += axes::test::GroupRig::cycle) {
        scan();
        if (condition()) return;
    }
    throw std::runtime_error("what a figure waited for did not happen; the group is in " + std::string(axes::name(view().state)));
}

Figure GroupStage::figure(const std::string& name) {
    figure_.name = name;
    figure_.period = to_seconds(axes::test::GroupRig::cycle);
    for (const auto& bar : bars_) figure_.traces.push_back({bar.label, bar.block, bar.on});
    return figure_;
}

}  // namespace taktwerk::figures
