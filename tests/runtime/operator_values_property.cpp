// Whatever people, pages and the machine do, in whatever order: a button is TRUE only while somebody who may holds it.

#include <array>
#include <optional>
#include <random>

#include "runtime/stop_levels.hpp"
#include "tests/property_cases.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using enum OperatorAction;

class Pressed final : public Program {
public:
    bool button = false, lamp = false;
    double number = 50;
    void declare(Declaration& d) override {
        (void)d.axis("x");
        d.operator_button("button", button);
        d.operator_switch("lamp", lamp);
        d.operator_value("number", number, {.minimum = 0, .maximum = 100});
        d.task<&Pressed::scan>("main");
    }
    void scan(TaskContext&) {}
};

/// The rules once more, from docs/views.md: who holds the button, and since when he has said nothing.
struct Rules {
    std::optional<std::uint32_t> holder;
    Instant heard{};
    void let_go() { holder.reset(); }
};

class ButtonWalk {
public:
    explicit ButtonWalk(std::uint64_t seed) : dice_(seed), m_(with_program(1, &entry_of<Pressed>, divisor())) {}

    void run() {
        ASSERT_TRUE(m_.up());
        for (int step = 0; step < 400; ++step) {
            if (step % 40 == 39) recover();
            else one_thing();
            check();
            if (::testing::Test::HasFailure()) {
                ADD_FAILURE() << "step " << step << ": " << did_;
                return;
            }
        }
        m_.run(std::chrono::milliseconds{250 + 2 * divisor_});
        EXPECT_EQ(variable(m_, "button"), 0) << "nobody says anything any more";
    }

private:
    std::uint16_t divisor() {
        divisor_ = std::array<std::uint16_t, 3>{1, 1, 10}[draw(3)];
        return divisor_;
    }
    std::uint32_t draw(std::uint32_t below) { return static_cast<std::uint32_t>(dice_() % below); }
    Instant now() { return m_.state().at; }

    /// Sent, and carried out in the next cycle: the answer.
    CommandAnswer send(OperatorAction action, std::uint16_t index, std::uint32_t client, bool flag = false, double value = 0) {
        OperatorCommand c;
        c.action = action;
        c.index = c.axis = index;
        c.client = client;
        c.flag = flag;
        c.value = value;
        c.sequence = ++sequence_;
        EXPECT_TRUE(m_.machine->submit(c));
        for (int i = 0; i < 4; ++i) {
            m_.run(1ms);
            while (const auto answer = m_.machine->next_answer())
                if (answer->sequence == sequence_) return *answer;
        }
        ADD_FAILURE() << "no answer";
        return {};
    }

    void hand(bool press) {
        const auto client = 1 + draw(2);
        did_ = press ? "a press" : "a renewal";
        const auto answer = send(set_value, 0, client, press, 1).answer;
        if (m_.state().emergency_stop || !running()) {
            EXPECT_NE(answer, Answer::accepted);
            return rules_.let_go();
        }
        // Over by its lease at the same time as this came: either is right, as long as it is one of them.
        if (answer != Answer::accepted) return;
        if (press) {
            EXPECT_TRUE(!rules_.holder || rules_.holder == client || now() - rules_.heard > 190ms) << "out of another's hand";
        } else {
            EXPECT_TRUE(rules_.holder == client) << "a renewal of what nobody of his holds";
        }
        rules_.holder = client;
        rules_.heard = now();
    }
    void one_thing() {
        switch (draw(12)) {
            case 0:
            case 1: return hand(true);
            case 2:
            case 3:
            case 4: return hand(false);
            case 5:
                did_ = "let go";
                EXPECT_EQ(send(set_value, 0, 1 + draw(2), false, 0).answer, Answer::accepted);
                return rules_.let_go();
            case 6: {
                did_ = "a client goes";
                const auto client = 1 + draw(2);
                (void)send(release_values, 0xFFFF, client);
                if (rules_.holder == client) rules_.let_go();
                return;
            }
            case 7:
                did_ = "a stop";
                (void)m_.machine->request_stop(draw(2) != 0 ? StopLevels::all_axes : std::uint16_t{0});
                m_.run(2ms);
                return rules_.let_go();
            case 8:
                if (draw(4) != 0) return;
                did_ = "the emergency stop";
                m_.world.set_input("estop_ok", false);
                m_.run(4ms);
                return rules_.let_go();
            case 9:
                if (draw(3) != 0) return;
                did_ = "the program stops";
                (void)send(program_stop, 0, 1);
                return rules_.let_go();
            case 10: {
                did_ = "a number";
                const double value = static_cast<double>(draw(140)) - 20;
                const bool fits = value >= 0 && value <= 100;
                EXPECT_EQ(send(set_value, 2, 1, false, value).answer, fits ? Answer::accepted : Answer::bad_value);
                if (fits) number_ = value;
                return;
            }
            default: did_ = "time"; m_.run(std::chrono::milliseconds{1 + draw(120)});
        }
    }
    bool running() { return m_.state().programs[0] == ProgramState::running; }
    void recover() {
        did_ = "everything comes back";
        m_.world.set_input("estop_ok", true);
        m_.run(10ms);
        (void)send(reset, 0xFFFF, 1);
        m_.run(50ms);
        (void)send(program_start, 0, 1);
        m_.run(std::chrono::milliseconds{20 + 2 * divisor_});
    }
    void check() {
        if (rules_.holder && now() - rules_.heard > 200ms) rules_.let_go();
        // What its scans see is at most a run of its task older than the rules; a tap that no run had seen is seen by one more.
        if (!rules_.holder) m_.run(std::chrono::milliseconds{3 * divisor_ + 1});
        if (!rules_.holder) {
            EXPECT_EQ(variable(m_, "button"), 0);
        }
        const double number = variable(m_, "number");
        if (divisor_ == 1 || !running()) {
            EXPECT_EQ(number, number_);
        }
    }

    std::uint16_t divisor_ = 1;
    std::mt19937_64 dice_;
    TestMachine m_;
    Rules rules_;
    double number_ = 50;
    std::uint64_t sequence_ = 0;
    const char* did_ = "";
};

TEST(OperatorValueWalk, AButtonIsTrueOnlyWhileSomebodyHoldsIt) {
    const auto cases = property_cases(12);
    for (std::size_t seed = 1; seed <= cases && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        ButtonWalk{static_cast<std::uint64_t>(seed)}.run();
    }
}

}  // namespace
}  // namespace taktwerk::runtime::testing
