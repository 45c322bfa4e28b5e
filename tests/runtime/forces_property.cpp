// Random walks of people who force, release and go, of programs, modes and emergency stops, against a model of a page: what each point shows and
// what the wire carries.

#include <map>
#include <random>

#include "runtime/alarms.hpp"
#include "tests/property_cases.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

/// Holds its outputs on.
class HoldsOn final : public Program {
public:
    Output<bool> a, b;
    void declare(Declaration& d) override {
        a = d.output("lamp");
        b = d.output("horn");
        d.task<&HoldsOn::scan>("main");
    }
    void scan(TaskContext& ctx) {
        ctx.set(a, true);
        ctx.set(b, true);
    }
};

MachineConfig with_points() {
    auto config = with_program(1, &entry_of<HoldsOn>);
    auto more = [&](std::size_t like, std::string name, std::uint8_t sub) {
        auto point = config.io[like];
        point.name = std::move(name);
        point.sub = sub;
        config.io.push_back(point);
    };
    more(1, "door", 3);
    more(1, "part", 4);
    more(2, "horn", 2);
    return config;
}

class Walk {
public:
    explicit Walk(unsigned seed) : random_(seed) {
        real_.assign(m_.machine->layout().inputs.size(), 0);
        real_[0] = 1;  // estop_ok
    }
    bool up() { return m_.up(); }

    void step() {
        switch (random_() % 10) {
            case 0:
            case 1:
            case 2: return force();
            case 3: return unforce();
            case 4: return leave(random_() % 8 == 0);
            case 5: return press(random_() % 3 == 0);
            case 6: return change(1 + random_() % (real_.size() - 1));
            case 7: return give(random_() % 2 ? OperatorAction::program_stop : OperatorAction::program_start, 0, false, 0), (void)0;
            case 8: return reset();
            default: break;
        }
        OperatorCommand c;
        c.action = OperatorAction::set_mode;
        c.mode = random_() % 3 ? Mode::automatic : Mode::manual;
        (void)give(c);
    }

    void compare(unsigned seed, int step) {
        m_.run(4ms);
        const auto& s = m_.state();
        const auto& layout = m_.machine->layout();
        ASSERT_EQ(s.force_count, forced_.size()) << "seed " << seed << ", step " << step;
        for (std::size_t i = 0; i < s.force_count; ++i) {
            const auto& shown = s.forces[i];
            const auto known = forced_.find({shown.direction == IoDirection::output, shown.index});
            ASSERT_NE(known, forced_.end()) << "seed " << seed << ", step " << step;
            EXPECT_EQ(shown.value, known->second.value);
            EXPECT_EQ(shown.client, known->second.client);
        }
        for (std::uint16_t i = 0; i < layout.inputs.size(); ++i) {
            const auto known = forced_.find({false, i});
            const double wanted = known != forced_.end() ? known->second.value : static_cast<double>(real_[i]);
            EXPECT_EQ(s.inputs[i], wanted) << layout.inputs[i] << ", seed " << seed << ", step " << step;
            EXPECT_EQ(s.input_values[i].value, wanted);
            EXPECT_TRUE(s.input_values[i].good);
        }
        const double written = s.programs[0] == ProgramState::running ? 1 : 0;  // else safe
        for (std::uint16_t i = 0; i < layout.outputs.size(); ++i) {
            const auto known = forced_.find({true, i});
            const double wanted = known != forced_.end() ? known->second.value : written;
            EXPECT_EQ(s.outputs[i], wanted) << layout.outputs[i] << ", seed " << seed << ", step " << step;
            EXPECT_EQ(static_cast<double>(m_.world.output_value(layout.outputs[i])), wanted)
                << layout.outputs[i] << " on the wire, seed " << seed << ", step " << step;
        }
        bool alarm = false;
        for (std::size_t i = 0; i < s.alarm_count; ++i)
            alarm = alarm || (s.alarms[i].fact.id == id(MachineAlarm::points_forced) && s.alarms[i].standing);
        EXPECT_EQ(alarm, !forced_.empty()) << "seed " << seed << ", step " << step;
    }

private:
    struct Force {
        double value = 0;
        std::uint32_t client = 0;
    };
    Answer give(OperatorCommand c) {
        c.sequence = ++sequence_;
        EXPECT_TRUE(m_.machine->submit(c));
        for (int i = 0; i < 5; ++i) {
            m_.run(1ms);
            while (const auto answer = m_.machine->next_answer())
                if (answer->sequence == sequence_) return answer->answer;
        }
        ADD_FAILURE() << "no answer";
        return Answer::stale;
    }
    Answer give(OperatorAction action, std::uint16_t index, bool flag, double value, std::uint32_t client = 1) {
        OperatorCommand c;
        c.action = action;
        c.index = index;
        c.flag = flag;
        c.value = value;
        c.client = client;
        return give(c);
    }
    void force() {
        const bool output = random_() % 2;
        const auto& layout = m_.machine->layout();
        const auto index = static_cast<std::uint16_t>(random_() % (output ? layout.outputs.size() : layout.inputs.size()));
        const double value = static_cast<double>(random_() % 3);  // 2 is none of a bit
        const auto client = static_cast<std::uint32_t>(1 + random_() % 3);
        const bool kept = !output && index == 0;
        const auto wanted = kept                                  ? Answer::not_possible_now
                            : value > 1                           ? Answer::bad_value
                            : output && m_.state().emergency_stop ? Answer::not_possible_now
                                                                  : Answer::accepted;
        EXPECT_EQ(give(OperatorAction::force, index, output, value, client), wanted);
        if (wanted == Answer::accepted) forced_[{output, index}] = {value, client};
    }
    void unforce() {
        const bool output = random_() % 2;
        const auto& layout = m_.machine->layout();
        const auto index = static_cast<std::uint16_t>(random_() % (output ? layout.outputs.size() : layout.inputs.size()));
        EXPECT_EQ(give(OperatorAction::unforce, index, output, 0), Answer::accepted);
        forced_.erase({output, index});
    }
    void leave(bool all) {
        const auto client = static_cast<std::uint32_t>(1 + random_() % 3);
        EXPECT_EQ(give(OperatorAction::release_forces, 0, !all, 0, client), Answer::accepted);
        std::erase_if(forced_, [&](const auto& entry) { return all || entry.second.client == client; });
    }
    void press(bool pressed) {
        real_[0] = pressed ? 0 : 1;
        m_.world.set_input("estop_ok", !pressed);
        m_.run(4ms);
        if (pressed) std::erase_if(forced_, [](const auto& entry) { return entry.first.first; });
    }
    void change(std::size_t input) {
        real_[input] = 1 - real_[input];
        m_.world.set_input(m_.machine->layout().inputs[input], real_[input] != 0);
    }
    void reset() {
        OperatorCommand c;
        c.action = OperatorAction::reset;
        (void)give(c);
    }

    std::mt19937 random_;
    TestMachine m_{with_points()};
    std::uint64_t sequence_ = 0;
    std::vector<int> real_;
    std::map<std::pair<bool, std::uint16_t>, Force> forced_;  // by (output, index)
};

TEST(ForcesProperty, WalksOfPeopleProgramsAndEmergencyStops) {
    const auto cases = property_cases(12);
    for (unsigned seed = 1; seed <= cases; ++seed) {
        Walk walk{seed};
        ASSERT_TRUE(walk.up());
        for (int step = 0; step < 120; ++step) {
            walk.step();
            walk.compare(seed, step);
            if (::testing::Test::HasFailure()) return;
        }
    }
}

}  // namespace
}  // namespace taktwerk::runtime::testing
