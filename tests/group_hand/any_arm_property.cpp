// Two persons at every arm of config/machines/, who know nothing and stop at nothing: every command in every state, several in one cycle, nonsense between,
// members moved alone, power and control taken, modes changed in the middle, connections and the bus lost, the emergency stop. any_arm_rig.hpp says what
// must hold in every cycle; beside it: who lets go stands, an increment ends exactly, and everything can be brought back.

#include <limits>
#include <random>

#include "tests/group_hand/any_arm_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::group_hand {
namespace {

class Mob {
public:
    Mob(std::uint64_t seed, const MachineArm& arm)
        : random_(seed), rig_(arm, {.manual = arm.turns ? 90.0 : 60.0, .setup = 60, .tool = seed % 3 == 0 ? 80.0 : 0}) {}

    void riot(int deeds) {
        rig_.make_ready();
        // Off what is stretched or level.
        (void)rig_.hold(rig_.jog_request("acs", rig_.arm.joints[1] + "+", 1, 15), 2s, rig_.a);
        (void)rig_.let_go(rig_.a);
        for (int i = 0; i < deeds && !failed(); ++i) {
            if (!usable() && whole(0, 2) == 0) rig_.make_ready(whole(0, 1) == 0 ? Mode::setup : Mode::manual);
            if (failed()) return;
            deed();
        }
        if (failed()) return said();
        (void)rig_.let_go(rig_.a);
        (void)rig_.let_go(rig_.b);
        rig_.make_ready();
    }
    [[nodiscard]] int jogs() const { return jogs_; }
    [[nodiscard]] int increments() const { return increments_; }
    [[nodiscard]] double fastest() const { return rig_.fastest_tool / rig_.tool_limit; }

private:
    void said() { ADD_FAILURE() << rig_.m.now().time_since_epoch().count() << rig_.history(); }
    static bool failed() { return ::testing::Test::HasFailure(); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    template <class List>
    const auto& one_of(const List& list) {
        return list[static_cast<std::size_t>(whole(0, static_cast<int>(std::size(list)) - 1))];
    }
    hmi::ClientId& somebody() { return whole(0, 2) == 0 ? rig_.b : rig_.a; }
    bool usable() {
        return rig_.seen().state == axes::GroupState::GroupStandby && rig_.seen().powered && rig_.m.snapshot().mode != Mode::automatic;
    }
    double nonsense() {
        static constexpr double numbers[] = {0,
                                             -0.0,
                                             1e-12,
                                             -1e-12,
                                             1e-300,
                                             1e9,
                                             -1e9,
                                             1e300,
                                             -1e300,
                                             1,
                                             -1,
                                             0.5,
                                             1e12,
                                             1e-308,
                                             std::numeric_limits<double>::infinity(),
                                             std::numeric_limits<double>::quiet_NaN(),
                                             250,
                                             2};
        return one_of(numbers);
    }

    std::string direction(const std::string& frame) {
        static constexpr const char* ways[] = {"x+",  "x-",  "y+",  "y-",    "z+",       "z-",     "rz+",
                                               "rz-", "rx+", "ry-", "x+ y-", "x- y+ z-", "z+ rz+", "x+ x-"};
        if (frame != "acs") return one_of(ways);
        std::string all;
        for (int n = whole(1, 3); n > 0; --n) all += (all.empty() ? "" : " ") + one_of(rig_.arm.joints) + (whole(0, 1) == 0 ? "+" : "-");
        return all;
    }
    hmi::CommandRequest some_jog() {
        static constexpr const char* frames[] = {"acs", "acs", "acs", "mcs", "mcs", "tcs", "pcs", "wcs", "pcs_2"};
        const std::string frame = one_of(frames);
        auto request = rig_.jog_request(frame, direction(frame), whole(0, 2) == 0 ? uniform(0.02, 1) : 1);
        if (whole(0, 4) == 0) request.group_jog.distance = uniform(0.1, 40);
        return request;
    }
    /// Anything that the gateway takes, but the end of the run and a search for a place.
    hmi::CommandRequest anything() {
        hmi::CommandRequest request;
        if (whole(0, 2) == 0) request = some_jog();
        else {
            do request.kind = static_cast<CommandKind>(whole(0, 34));
            while (request.kind == CommandKind::shutdown || request.kind == CommandKind::home ||
                   request.kind == CommandKind::set_parameter);
            const std::string targets[] = {rig_.arm.group, rig_.arm.joints.front(), rig_.arm.joints.back(), "all", "",
                                           "nobody",       one_of(rig_.arm.joints)};
            request.target = one_of(targets);
            request.mode = static_cast<Mode>(whole(0, 3));
        }
        if (whole(0, 3) == 0) request.value = nonsense();
        if (whole(0, 5) == 0) request.value2 = nonsense();
        if (whole(0, 5) == 0) request.group_jog.distance = nonsense();
        if (whole(0, 9) == 0) request.group_jog.frame = "sky";
        if (whole(0, 9) == 0) request.group_jog.direction = "x+ +- elbow rx x- \t \xff";
        if (whole(0, 3) == 0) request.press = !request.press;
        if (whole(0, 9) == 0) request.commissioning = true;
        request.valid_for = 250ms;
        return request;
    }

    void deed() {
        const auto& joint = one_of(rig_.arm.joints);
        switch (whole(0, 17)) {
            case 0:
            case 1:
            case 2:
            case 3: return press();
            case 4:
            case 16: return increment();
            case 5: {  // in one cycle
                for (int n = whole(2, 5); n > 0; --n) (void)rig_.send(anything(), somebody());
                return rig_.run(std::chrono::milliseconds{whole(1, 60)});
            }
            case 6: {
                auto request = some_jog();  // pressed, and the mode changed in the same cycle
                (void)rig_.send(request, rig_.a);
                (void)rig_.send(AnyArmRig::mode_request(whole(0, 1) == 0 ? Mode::setup : Mode::manual), rig_.a);
                if (whole(0, 1) == 0) (void)rig_.send(request, rig_.a);
                return rig_.run(std::chrono::milliseconds{whole(1, 80)});
            }
            case 7: return (void)rig_.mode(static_cast<Mode>(whole(0, 9) == 0 ? 2 : whole(0, 1)));
            case 8: return (void)rig_.order(somebody(), CommandKind::group_override, rig_.arm.group, whole(0, 2) == 0 ? 0 : uniform(0, 1));
            case 9:
                return (void)rig_.order(somebody(), CommandKind::override_velocity, whole(0, 1) == 0 ? joint : "all",
                                        whole(0, 1) == 0 ? 1 : uniform(0, 1));
            case 10: {  // a member alone, by the other one, perhaps while the group is jogged
                hmi::CommandRequest alone;
                alone.kind = CommandKind::jog;
                alone.target = joint;
                alone.value = uniform(-20, 20);
                alone.press = true;
                alone.valid_for = 250ms;
                const auto& who = somebody();
                for (int n = whole(1, 6); n > 0; --n, alone.press = false) {
                    (void)rig_.send(alone, who);
                    rig_.run(50ms);
                }
                return;
            }
            case 11: return (void)rig_.order(somebody(), whole(0, 1) == 0 ? CommandKind::disable : CommandKind::enable, joint);
            case 12: {
                static constexpr CommandKind kinds[] = {CommandKind::group_interrupt, CommandKind::group_continue,
                                                        CommandKind::group_halt,      CommandKind::group_enable,
                                                        CommandKind::group_disable,   CommandKind::group_reset};
                return (void)rig_.order(somebody(), one_of(kinds), rig_.arm.group);
            }
            case 13: return (void)rig_.order(somebody(), CommandKind::stop, whole(0, 1) == 0 ? "" : joint);
            case 14: {
                rig_.lose(somebody());
                return rig_.run(std::chrono::milliseconds{whole(0, 300)});
            }
            case 15: {
                if (!rig_.arm.emergency || whole(0, 2) != 0) return rig_.run(std::chrono::milliseconds{whole(150, 900)});
                rig_.m.world().set_input("estop_ok", false);
                rig_.run(std::chrono::milliseconds{whole(1, 700)});
                return rig_.m.world().set_input("estop_ok", true);
            }
            default: return rig_.run(std::chrono::milliseconds{whole(1, 200)});
        }
    }

    void press() {
        auto request = some_jog();
        auto& who = somebody();
        if (!rig_.jog(request, who).accepted()) return;
        ++jogs_;
        request.press = false;
        for (int n = whole(0, 20); n > 0; --n) {
            rig_.run(std::chrono::milliseconds{whole(20, 60)});
            if (whole(0, 14) == 0) (void)rig_.send(anything(), somebody());
            if (whole(0, 9) == 0 && request.group_jog.distance == 0) request.group_jog.direction = direction(request.group_jog.frame);
            if (whole(0, 9) == 0) request.value = uniform(0.05, 1);
            if (!rig_.jog(request, who).accepted()) break;
        }
        if (whole(0, 1) == 0) return;
        (void)rig_.let_go(who);
        if (whole(0, 1) == 0) return;
        // Nobody else holds it: it stands.
        EXPECT_TRUE(rig_.until([&] { return rig_.stands() || rig_.m.snapshot().mode == Mode::automatic; }, AnyArmRig::longest_stop))
            << rig_.arm.machine << ": let go";
    }

    void increment() {
        if (!usable() || !rig_.stands()) return;
        static constexpr const char* ways[] = {"x+", "x-", "y+", "y-", "z+", "z-"};
        const std::string way = one_of(ways);
        const double distance = whole(0, 3) == 0 ? uniform(0.001, 0.1) : uniform(1, 30);
        const Point from = rig_.tool();
        const auto last = rig_.hold(rig_.jog_request("mcs", way, uniform(0.2, 1), distance), 3s, rig_.a);
        const bool arrived = last.accepted() && rig_.seen().state == axes::GroupState::GroupStandby;
        if (arrived && rig_.seen().jog_end == axes::JogEnd::distance && rig_.own_tool) {
            ++increments_;
            Point to = from;
            to[static_cast<std::size_t>(way[0] - 'x')] += way[1] == '+' ? distance : -distance;
            const Point is = rig_.tool();
            for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(is[k], to[k], 1e-7) << rig_.arm.machine << ' ' << way << ' ' << distance;
        }
        (void)rig_.let_go(rig_.a);
        (void)rig_.until([&] { return rig_.stands(); }, AnyArmRig::longest_stop);
    }

    std::mt19937_64 random_;
    AnyArmRig rig_;
    int jogs_ = 0, increments_ = 0;
};

TEST(AnyArmProperty, WhoeverDoesWhatever) {
    const auto arms = machine_arms();
    int jogs = 0, increments = 0;
    double fastest = 0;
    for (std::size_t i = 0; i < property_cases(arms.size()) && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "riot " << i << " at " << arms[i % arms.size()].machine);
        Mob mob(5200 + i, arms[i % arms.size()]);
        mob.riot(60);
        jogs += mob.jogs();
        increments += mob.increments();
        fastest = std::max(fastest, mob.fastest());
    }
    EXPECT_GT(jogs, 20) << "who moves nothing shows nothing";
    EXPECT_GT(increments, 2);
    EXPECT_GT(fastest, 0.9) << "a limit that is never met shows nothing";
}

}  // namespace
}  // namespace taktwerk::group_hand
