#pragma once
// A whole machine of one axis in virtual time that is measured as a person does it: pressed, renewed, the samples fetched beside the cycle.

#include "axes/measuring/aligned_run.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {

struct MeasuringRig : TestMachine {
    explicit MeasuringRig(MachineConfig config = measured()) : TestMachine(std::move(config)) {
        runner->after_cycle = [this, before = runner->after_cycle](Instant now) {
            before(now);
            axes::MeasureSample sample;
            while (machine->next_measure_sample(sample)) samples.push_back(sample);
        };
        started = up();
        enable(0);
        home(0);
    }

    /// Homed in place at 400 mm, in the middle of its way.
    static MachineConfig measured() {
        auto config = machine_config(1);
        auto& binding = config.axes[0];
        binding.axis.homing.kind = axes::HomingKind::set_here;
        binding.axis.homing.offset = 400;
        binding.axis.following.window = 20;
        binding.axis.manual = {100, 400, 50};
        binding.axis.windows.in_position = 0.01;
        binding.simulation.start = 0;
        binding.simulation.home_from.reset();
        binding.simulation.home_to.reset();
        for (auto* end : {&binding.simulation.negative_limit, &binding.simulation.negative_stop}) *end = -500;
        for (auto* end : {&binding.simulation.positive_limit, &binding.simulation.positive_stop}) *end = 500;
        return config;
    }

    CommandAnswer press(const axes::MeasureOrder& order, std::uint16_t axis = 0) {
        OperatorCommand c;
        c.action = OperatorAction::measure;
        c.axis = axis;
        c.flag = true;
        c.measure = order;
        samples.clear();
        return command(c);
    }
    Answer renew() {
        OperatorCommand c;
        c.action = OperatorAction::measure;
        c.axis = 0;
        return command(c).answer;
    }
    const MeasureState& measure_state() { return state().measure; }
    /// Held to its end, or for `most`.
    axes::measuring::SampleRun measure(const axes::MeasureOrder& order, Duration most = 310s) {
        EXPECT_EQ(press(order).answer, Answer::accepted);
        for (Duration held{}; measure_state().running && held < most; held += 50ms) {
            run(45ms);
            if (measure_state().running) renew();
        }
        return {measure_state().plan, samples};
    }

    std::vector<axes::MeasureSample> samples;
    bool started = false;
};

}  // namespace taktwerk::runtime::testing
