// Programs drawn at random, given early, late, overridden and interrupted: every command comes to its end in its order, the last one where it was to
// end, and no member is ever beyond a limit or away from one motion (the rig's oracle, every cycle).

#include <gtest/gtest.h>

#include <random>

#include "tests/axes/group/group_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

class Drawn {
public:
    explicit Drawn(std::uint64_t seed, const Arm& arm) : random_(seed), rig_(3, arm), machine_(arm != nullptr) {}

    void run() {
        rig_.enable();
        const int commands = whole(4, 9);
        std::size_t finished = 0;
        CommandId last_done = 0;
        int given = 0;
        for (int i = 0; i < 200'000 && !::testing::Test::HasFailure(); ++i) {
            if (given < commands && rig_.view().queued_count < 16 && uniform(0, 1) < (given % 5 == 0 ? 0.004 : 0.2)) {
                const auto answer = rig_.submit(next());
                ASSERT_EQ(answer.error, ErrorId::none);
                ids_.push_back(answer.id);
                ++given;
            }
            if (uniform(0, 1) < 0.002) {
                ASSERT_EQ(rig_.set(Override{uniform(0, 1) < 0.1 ? 0 : uniform(0.05, 1), uniform(0.3, 1), uniform(0.3, 1)}), ErrorId::none);
            }
            if (i % 5000 == 4999) {
                ASSERT_EQ(rig_.set(Override{1, 1, 1}), ErrorId::none);
            }
            if (rig_.view().interrupted) {
                ASSERT_EQ(rig_.submit(simply(GroupCommandKind::resume)).error, ErrorId::none);
            } else if (uniform(0, 1) < 0.001) {
                (void)rig_.submit(simply(GroupCommandKind::interrupt));
            }
            rig_.step();
            while (finished < ids_.size()) {
                const auto status = rig_.status(ids_[finished]);
                if (status != CommandStatus::done) break;
                EXPECT_GT(ids_[finished], last_done) << "in their order";
                last_done = ids_[finished++];
            }
            if (given == commands && finished == ids_.size() && rig_.view().state == GroupState::GroupStandby) break;
        }
        EXPECT_EQ(finished, static_cast<std::size_t>(commands));
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(rig_.point()[k], at_[k], 1e-9 * 100) << k;
    }

private:
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

    GroupCommand next() {
        JointVector to = at_;
        const double size = std::exp(uniform(std::log(0.1), std::log(60.0)));
        for (std::size_t k = 0; k < 3; ++k) to[k] += uniform(-size, size);
        GroupCommand command = line(to, std::exp(uniform(std::log(2.0), std::log(200.0))), static_cast<MC_BufferMode>(whole(1, 5)));
        command.transition = static_cast<MC_TransitionMode>(whole(0, 4));
        const bool by_velocity = command.transition == mcTMStartVelocity || command.transition == mcTMConstantVelocity;
        command.transition_parameter = by_velocity ? uniform(0, 1) : uniform(0, size);
        if (machine_) command.frame = mcMCS;
        if (machine_ && uniform(0, 1) < 0.4) {
            command.kind = GroupCommandKind::circular_absolute;
            command.circle = {.mode = mcBORDER};
            for (std::size_t k = 0; k < 3; ++k) command.circle.aux[k] = (at_[k] + to[k]) / 2 + uniform(0.1, 1) * size;
        }
        at_ = to;
        return command;
    }

    std::mt19937_64 random_;
    GroupRig rig_;
    bool machine_;
    JointVector at_{};
    std::vector<CommandId> ids_;
};

// G-025, G-055, G-058, G-062, G-067, G-071
TEST(GroupPathProperty, ProgramsOfAxesArrive) {
    for (std::size_t i = 0; i < property_cases(2) && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "program " << i);
        Drawn(3000 + i, nullptr).run();
    }
}

TEST(GroupPathProperty, ProgramsOfThePoseArrive) {
    for (std::size_t i = 0; i < property_cases(5) && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "program " << i);
        Drawn(4000 + i, cartesian_arm()).run();
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
