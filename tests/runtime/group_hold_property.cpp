// What a person holds of a group, on a whole machine: a random walk of a person over the commands of groups, modes, programs and his own hand, beside two
// programs that ask the group, its members alone and what may follow them for whatever comes to their minds, while drives fail. Once it rests and he was told so,
// no program moves it until he lets it go, stops it, or a program disables it; the hold lasts as long, whatever happens.

#include <cstdio>
#include <random>
#include <string>

#include "tests/property_cases.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using namespace testing;
using axes::AxisCommand;
using axes::AxisState;
using axes::CommandKind;
using axes::GroupCommand;
using axes::GroupCommandKind;
using axes::GroupState;
using axes::Owner;

/// Of the programs that are built next: what they draw, they draw from this.
std::uint64_t wanderers_seed = 0;  // NOLINT

/// `powers`: gives all axes power, enables both groups and resets them, too.
template <bool powers>
class Wanders : public Program {
public:
    std::array<AxisRef, 4> axis;
    axes::GroupRef table, second;
    std::array<fb::MC_Power, 4> power;
    std::int64_t asked = 0, taken = 0;

    Wanders() : random_(2 * wanderers_seed + (powers ? 1 : 0)) {}
    void declare(Declaration& d) override {
        axis = {d.axis("x"), d.axis("y"), d.axis("z"), d.axis("a3")};
        table = d.axis_group("table");
        second = d.axis_group("second");
        d.monitor(powers ? "asked_p" : "asked_q", asked);
        d.monitor(powers ? "taken_p" : "taken_q", taken);
        d.task<&Wanders::scan>("main");
    }
    void scan(TaskContext& ctx) {
        for (std::size_t i = 0; powers && i < axis.size(); ++i) {
            power[i].Axis = axis[i];
            power[i].Enable = true;
            power[i](ctx);
        }
        if (powers && whole(0, 300) == 0) bring_back(ctx);
        if (jog_ != 0 && --jog_left_ > 0) (void)ctx.groups->set(table, axes::HoldJog{.id = jog_, .direction = {1}}, Owner::program);
        if (pause_-- > 0) return;
        pause_ = chance(0.3) ? whole(0, 3) : whole(10, powers ? 200 : 600);
        ask(ctx);
    }

private:
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    bool chance(double p) { return uniform(0, 1) < p; }

    void bring_back(TaskContext& ctx) {
        for (const auto group : {table, second}) {
            (void)ctx.groups->reset(group, Owner::program);
            if (ctx.groups->view(group)->state == GroupState::GroupDisabled)
                (void)ctx.groups->set(group, axes::EnableGroup{}, Owner::program);
        }
        for (const auto one : axis) (void)ctx.requests->reset(one, Owner::program);
    }
    axes::CommandId give(TaskContext& ctx, const GroupCommand& command, axes::GroupRef group) {
        const auto answer = ctx.groups->submit(group, command, Owner::program);
        ++asked;
        taken += answer.error == axes::ErrorId::none;
        return answer.error == axes::ErrorId::none ? answer.id : 0;
    }
    void give_alone(TaskContext& ctx, const AxisCommand& command, std::size_t which) {
        ++asked;
        taken += ctx.requests->submit(axis[which], command, Owner::program).error == axes::ErrorId::none;
    }
    void ask(TaskContext& ctx) {
        const auto group = chance(0.85) ? table : second;
        const auto mode = chance(0.5) ? axes::mcAborting : axes::mcBuffered;
        const auto member = static_cast<std::size_t>(whole(0, 2));
        switch (whole(0, powers ? 19 : 21)) {
            case 0:
            case 1:
            case 2:
            case 3:
            case 4: {
                GroupCommand line{.kind = GroupCommandKind::linear_absolute, .buffer_mode = mode};
                line.target = {uniform(0, 500), group == table ? uniform(0, 500) : 0.0};
                line.dynamics = {.velocity = uniform(50, 300)};
                (void)give(ctx, line, group);
                return;
            }
            case 5: return void(give(ctx, {.kind = GroupCommandKind::halt}, group));
            case 6:
                if (chance(0.5)) stop_ = give(ctx, {.kind = GroupCommandKind::stop}, table);
                return;
            case 7:
            case 8: return ctx.groups->release_stop(table, stop_, Owner::program);
            case 9: return void(give(ctx, {.kind = GroupCommandKind::interrupt}, group));
            case 10:
            case 11: return void(give(ctx, {.kind = GroupCommandKind::resume}, group));
            case 12: return void(give(ctx, {.kind = GroupCommandKind::wait, .buffer_mode = mode, .duration = 1ms * whole(0, 200)}, group));
            case 13:
                jog_ = give(ctx, {.kind = GroupCommandKind::jog, .target = {1}}, table);
                jog_left_ = whole(1, 200);
                return;
            case 14: return void(ctx.groups->set(group, axes::Override{chance(0.7) ? 1 : chance(0.5) ? 0 : 0.3, 1, 1}, Owner::program));
            case 15:
                return void(ctx.groups->set(chance(0.5) ? table : second,
                                            axes::FollowPath{.slave = axis[static_cast<std::size_t>(whole(0, 3))]}, Owner::program));
            case 16:
                return give_alone(ctx, {.kind = CommandKind::move_absolute, .position = uniform(0, 500), .velocity = uniform(20, 200)},
                                  member);
            case 17: return give_alone(ctx, {.kind = CommandKind::move_superimposed, .position = uniform(-20, 20), .velocity = 30}, member);
            case 18: return give_alone(ctx, {.kind = chance(0.5) ? CommandKind::halt : CommandKind::halt_superimposed}, member);
            case 19: {
                AxisCommand gear{.kind = CommandKind::gear_in};
                gear.details = axes::GearDetails{.master = axis[3], .ratio = {}};
                if (chance(0.5)) return give_alone(ctx, gear, member);
                return give_alone(ctx, {.kind = CommandKind::move_velocity, .velocity = uniform(-20, 20)}, 3);
            }
            case 20:
                if (chance(0.1)) (void)give(ctx, {.kind = GroupCommandKind::disable}, table);
                return;
            case 21: return give_alone(ctx, {.kind = CommandKind::jog, .velocity = 20}, member);
        }
    }

    std::mt19937_64 random_;
    axes::CommandId stop_ = 0, jog_ = 0;
    int pause_ = 20, jog_left_ = 0;
};

MachineConfig wandering(std::uint64_t seed) {
    wanderers_seed = seed;
    auto config = with_program(4, entry_of<Wanders<true>>);
    add_program(config, "q", entry_of<Wanders<false>>);
    for (auto& binding : config.axes) {
        binding.axis.require_homed = false;
        binding.axis.limits.position_min = -1e6;
        binding.axis.limits.position_max = 1e6;
        binding.simulation.negative_limit = binding.simulation.negative_stop = -1e6;
        binding.simulation.positive_limit = binding.simulation.positive_stop = 1e6;
    }
    config.axis_groups.push_back({.name = "table", .members = {"x", "y"}, .kinematics = {}});
    config.axis_groups.push_back({.name = "second", .members = {"z"}, .kinematics = {}});
    return config;
}

class PersonsWalk {
public:
    explicit PersonsWalk(std::uint64_t seed) : random_(seed), m_(wandering(seed)) {
        const auto before = m_.runner->after_cycle;
        m_.runner->after_cycle = [this, before](Instant now) {
            before(now);
            if (m_.machine->latest() != nullptr) look();
        };
        EXPECT_TRUE(m_.up());
    }
    void walk(int steps) {
        for (int i = 0; i < steps && !::testing::Test::HasFailure(); ++i) {
            act();
            m_.run(1ms * (chance(0.3) ? whole(1, 5) : whole(20, 400)));
        }
    }
    /// Whatever has become of it, he can end it.
    void end() {
        if (::testing::Test::HasFailure()) return;
        told_ = expected_ = false;
        (void)m_.machine->request_stop(0);
        m_.run(3ms);
        EXPECT_FALSE(seen().held) << story_;
    }
    std::size_t rests = 0;
    std::uint64_t cycles_held = 0;
    [[nodiscard]] double asked() { return variable(m_, "asked_p") + variable(m_, "asked_q"); }

private:
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    bool chance(double p) { return uniform(0, 1) < p; }
    const SeenGroup& seen() { return m_.state().groups[0]; }
    void say(const std::string& what) {
        story_ += std::to_string(m_.state().statistics.cycles) + " " + what + " (" + std::string(axes::name(seen().state)) +
                  (seen().held ? " held" : "") + (seen().interrupted ? " interrupted" : "") + ")\n";
    }
    Answer give(OperatorAction action, std::uint16_t target, const std::string& what, bool flag = false, double value = 0) {
        const auto answer = m_.command(action, target, flag, value);
        say(what + " -> " + std::to_string(static_cast<int>(answer.answer)) + " " + std::to_string(static_cast<int>(answer.error)));
        return answer.answer;
    }

    void act() {
        const bool automatic = m_.state().mode == Mode::automatic;
        switch (whole(0, 19)) {
            case 0:
            case 1:
            case 2:
            case 3:
            case 4:
            case 5:
                if (give(OperatorAction::group_interrupt, 0, "interrupt") == Answer::accepted) expected_ = true;
                return;
            case 6:
            case 7:
            case 8: {
                lets_go_ = true;  // from when it is taken, which is before the answer comes
                const bool taken = give(OperatorAction::group_continue, 0, "continue") == Answer::accepted;
                lets_go_ = false;
                if (taken) told_ = expected_ = false;
                return;
            }
            case 9:
                if (!chance(0.3)) return;
                say("stop");
                told_ = expected_ = false;
                (void)m_.machine->request_stop(static_cast<std::uint16_t>(whole(0, 1)));
                return m_.run(3ms);
            case 10: return void(give(OperatorAction::group_override, 0, "override", false, chance(0.7) ? 1 : chance(0.5) ? 0 : 0.3));
            case 11: {
                if (chance(0.2)) {
                    m_.world.set_input("estop_ok", false);
                    m_.run(100ms);
                    m_.world.set_input("estop_ok", true);
                    return say("emergency stop");
                }
                if (!chance(0.5)) return;
                const auto drive = std::string(1, static_cast<char>('x' + whole(0, 2)));
                say("fault of " + drive);
                return m_.world.drive(drive)->raise(0x2310);
            }
            case 12:
            case 13: {
                const auto program = static_cast<std::uint16_t>(whole(0, 1));
                return void(give(OperatorAction::program_stop, program, "end of program " + std::to_string(program)));
            }
            case 14: {
                if (!chance(0.4)) return;
                const auto wanted = chance(0.5) ? Mode::manual : Mode::setup;
                told_ = false;  // until it is automatic again
                const auto answer = m_.mode(wanted);
                return say("mode " + std::to_string(static_cast<int>(wanted)) + " -> " + std::to_string(static_cast<int>(answer.answer)));
            }
            case 15:
                if (automatic) return;
                return void(give(OperatorAction::power, 0xFFFF, "power", true));
            case 16: {
                if (automatic) return;
                OperatorCommand jog;
                jog.action = OperatorAction::group_jog;
                jog.index = 0;
                jog.flag = true;
                jog.value = 1;
                jog.group_jog = {axes::mcACS, 1, 0};
                say("jogs the group -> " + std::to_string(static_cast<int>(m_.command(jog).answer)));
                m_.run(150ms);
                jog.flag = false;
                jog.value = 0;
                say("lets the key go -> " + std::to_string(static_cast<int>(m_.command(jog).answer)));
                return;
            }
            case 17:
                if (automatic) return;
                (void)give(OperatorAction::jog, 0, "jogs x", true, 20);
                m_.run(100ms);
                return void(give(OperatorAction::jog, 0, "lets x go"));
            default: {
                (void)give(OperatorAction::reset, 0xFFFF, "reset");
                if (!automatic) (void)m_.mode(Mode::automatic);
                for (std::uint16_t p = 0; p < 2; ++p) (void)m_.command(OperatorAction::program_start, p);
                return say("automatic, start");
            }
        }
    }

    void look() {
        const auto& now = seen();
        if (now.state == GroupState::GroupDisabled) told_ = expected_ = false;
        if (lets_go_ && !now.held) told_ = expected_ = false;
        if (expected_ && !::testing::Test::HasFailure()) {
            EXPECT_TRUE(now.held) << "the hold is lost in cycle " << m_.state().statistics.cycles << "\n" << story_;
        }
        if (!expected_) told_ = rested_ = false;
        if (m_.state().mode != Mode::automatic) return;
        const bool powered = m_.axis(0).powered && m_.axis(1).powered;
        if (!powered) told_ = false;
        if (told_) ++cycles_held;
        for (std::size_t i = 0; told_ && i < 2 && !::testing::Test::HasFailure(); ++i) {
            EXPECT_NEAR(m_.axis(i).set_position, at_[i], 1e-6) << "axis " << i << " in cycle " << m_.state().statistics.cycles << "\n"
                                                               << story_;
        }
        const bool stands = m_.axis(0).state == AxisState::Standstill && m_.axis(1).state == AxisState::Standstill;
        rested_ = rested_ || now.interrupted;
        if (told_ || !expected_ || !powered || !rested_ || !stands) return;
        told_ = true;
        ++rests;
        for (std::size_t i = 0; i < 2; ++i) at_[i] = m_.axis(i).set_position;
    }

    std::mt19937_64 random_;
    TestMachine m_;
    std::array<double, 2> at_{};
    std::string story_;
    bool expected_ = false, told_ = false, lets_go_ = false;
    bool rested_ = false;  // it has come to rest for him: whatever it goes through from then on, it stands when it has power
};

TEST(GroupHoldWalk, NothingOfAProgramMovesWhatAPersonHolds) {
    std::size_t rests = 0;
    std::uint64_t held = 0;
    double asked = 0;
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + property_cases(6) && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        PersonsWalk walk(seed);
        walk.walk(120);
        walk.end();
        rests += walk.rests;
        held += walk.cycles_held;
        asked += walk.asked();
    }
    EXPECT_GT(rests, 10u);
    EXPECT_GT(held, 10'000u);
    EXPECT_GT(asked, 500);
    std::printf("held at rest %zu times, for %llu cycles; %.0f commands of programs\n", rests, static_cast<unsigned long long>(held),
                asked);
}

}  // namespace
}  // namespace taktwerk::runtime
