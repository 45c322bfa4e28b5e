#pragma once
// A program on an arm, given as fast as it is taken until somebody stops it.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/axes/group/drawn_program.hpp"
#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {

struct GivenProgram {
    GivenProgram(const JogArm& arm, const Arm& kinematics, const std::vector<DrawnMove>& moves)
        : rig(axes_of(arm), kinematics), moves_(moves) {
        for (std::size_t i = 0; i < rig.axes.size(); ++i)
            EXPECT_EQ(rig.axes[i].submit({.kind = CommandKind::home, .position = arm.start[i]}, Owner::program).error, ErrorId::none);
        rig.run(50);
        rig.enable();
    }
    void step() {
        for (; !stopped && given_ < moves_.size() && rig.view().queued_count < GroupView::most_waiting; ++given_)
            ASSERT_EQ(rig.submit(moves_[given_].command).error, ErrorId::none) << "move " << given_;
        rig.step();
        rig.path.clear();
    }
    [[nodiscard]] bool beside(const GivenProgram& other) const {
        for (std::size_t k = 0; k < rig.axes.size(); ++k)
            if (std::fabs(rig.axis(k).set_position - other.rig.axis(k).set_position) > 1e-9) return true;
        return false;
    }
    [[nodiscard]] bool stands() const { return rig.view().path_velocity == 0; }
    int to_rest() {
        int cycles = 0;
        for (; !stands() && cycles < 10'000; ++cycles) step();
        return cycles;
    }

    GroupRig rig;
    bool stopped = false;

private:
    const std::vector<DrawnMove>& moves_;
    std::size_t given_ = 0;
};

}  // namespace taktwerk::axes::test
