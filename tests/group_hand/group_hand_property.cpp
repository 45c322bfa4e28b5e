// Two careless people at one SCARA, through the gateway: they press, renew, let go, lose their connection, stop, override, change the mode, at random. The
// rig asserts in every cycle: set-points continuous and inside the limits; the tool within reduced speed in set-up mode; and nothing moves without a live
// hand for longer than a lease and a stop take.

#include <random>

#include "tests/group_hand/hand_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::group_hand {
namespace {

class Walk {
public:
    explicit Walk(std::uint64_t seed) : random_(seed), rig_({.manual = 250, .setup = 200}) { rig_.watches_hand = true; }

    void go(int deeds) {
        rig_.bend();
        for (int i = 0; i < deeds && !::testing::Test::HasFailure(); ++i) deed();
        (void)rig_.let_go(rig_.a);
        (void)rig_.let_go(rig_.b);
        rig_.run(1s);
        EXPECT_TRUE(rig_.stands());
        EXPECT_NE(rig_.seen().state, axes::GroupState::GroupErrorStop);
        EXPECT_GT(presses_, deeds / 10) << "a hand that moves nothing shows nothing";
    }
    [[nodiscard]] int expired() const { return expired_; }
    [[nodiscard]] int in_setup() const { return in_setup_; }

private:
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    hmi::ClientId& somebody() { return whole(0, 3) == 0 ? rig_.b : rig_.a; }

    HandRig::Given order() {
        static constexpr const char* ways[] = {"x+", "x-", "y+", "y-", "z+", "z-", "rz+", "rz-", "x+ y-"};
        static constexpr const char* axes[] = {"shoulder+", "shoulder-", "elbow+",           "elbow-",          "lift+",
                                               "lift-",     "wrist+",    "shoulder+ elbow+", "shoulder- elbow-"};
        static constexpr const char* frames[] = {"mcs", "tcs", "pcs"};
        HandRig::Given given;
        given.frame = whole(0, 1) == 0 ? "acs" : frames[whole(0, 2)];
        given.direction = given.frame == "acs" ? axes[whole(0, 8)] : ways[whole(0, 8)];
        given.velocity = whole(0, 1) == 0 ? 1 : uniform(0.05, 1);
        if (whole(0, 4) == 0) given.distance = uniform(0.5, 20);
        return given;
    }

    void deed() {
        switch (whole(0, 11)) {
            case 0:
            case 1:
            case 2:
            case 3: {
                auto given = order();
                const auto who = somebody();
                if (!rig_.jog(given, who).accepted()) break;
                ++presses_;
                in_setup_ += rig_.setup_at ? 1 : 0;
                given.press = false;
                for (int n = whole(0, 12); n > 0; --n) {
                    rig_.run(std::chrono::milliseconds{whole(20, 70)});
                    // Another direction under the same hand, now and then; a stranger's renewal never counts.
                    if (whole(0, 9) == 0 && given.distance == 0) given.direction = given.frame == "acs" ? "elbow-" : "y-";
                    if (!rig_.jog(given, who).accepted()) break;
                    EXPECT_FALSE(rig_.jog(given, who == rig_.a ? rig_.b : rig_.a).accepted());
                }
                break;
            }
            case 4: (void)rig_.let_go(somebody()); break;
            case 5: {  // the connection is lost
                auto& who = somebody();
                rig_.gateway.close(who);
                who = rig_.gateway.open(hmi::Source::socket, "panel", hmi::Rights::commissioning);
                break;
            }
            case 6: (void)rig_.order(somebody(), CommandKind::stop, ""); break;
            case 7: (void)rig_.order(somebody(), CommandKind::group_halt, "arm"); break;
            case 8: (void)rig_.mode(whole(0, 1) == 0 ? Mode::setup : Mode::manual); break;
            case 9: (void)rig_.order(somebody(), CommandKind::group_override, "arm", whole(0, 3) == 0 ? 0.2 : 1); break;
            case 10:  // nobody renews
                rig_.run(std::chrono::milliseconds{whole(150, 900)});
                expired_ += rig_.m.alarms().find("no renewal") != std::string::npos ? 1 : 0;
                break;
            default: rig_.run(std::chrono::milliseconds{whole(1, 80)}); break;
        }
    }

    std::mt19937_64 random_;
    HandRig rig_;
    int presses_ = 0, expired_ = 0, in_setup_ = 0;
};

TEST(GroupHandProperty, TwoCarelessPeople) {
    int expired = 0, in_setup = 0;
    for (std::size_t i = 0; i < property_cases(3) && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "walk " << i);
        Walk walk(4400 + i);
        walk.go(50);
        expired += walk.expired();
        in_setup += walk.in_setup();
    }
    EXPECT_GT(expired, 0) << "leases run out";
    EXPECT_GT(in_setup, 3) << "set-up mode is jogged in";
}

}  // namespace
}  // namespace taktwerk::group_hand
