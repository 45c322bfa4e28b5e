#pragma once
// A person's hand on the SCARA of config/machines/, through the gateway, in manual and set-up mode. In every cycle: set-points are continuous and inside the
// limits of axis and mode; in set-up mode the tool, placed by the two links by hand, goes no faster than it may; and nothing moves without a hand on it
// for longer than a stop takes.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "tests/group_hand/gateway_hand.hpp"

namespace taktwerk::group_hand {

inline constexpr std::array<const char*, 4> joints{"shoulder", "elbow", "lift", "wrist"};

/// What a hand may at most be taken away before everything stands: 0.25 s of the lease (five cycles beyond it until the planner has answered count to
/// the ramp), and the slowest ramp of this machine by hand: 300 deg/s by 2000 deg/s2 and 40000 deg/s3 is 300/2000 + 2000/40000 = 0.2 s; a path in the
/// machine brakes with what is left of that to its slowest joint, which is taken as three times that.
inline constexpr auto longest_ramp = 600ms;

struct Speeds {
    double manual = 75, setup = 15;  ///< deg/s, of each axis; of the lift mm/s
    double tool = 0;                 ///< mm/s in set-up mode; 0: as without a word
};

class HandRig : public GatewayHand {
public:
    struct Given {
        std::string frame = "mcs", direction = "";
        double velocity = 1, distance = 0;
        bool press = true;
    };

    explicit HandRig(const Speeds& speeds = {})
        : GatewayHand{"scara",
                      [&](runtime::MachineConfig& config) {
                          config.start_mode = Mode::manual;
                          for (auto& binding : config.axes) {
                              binding.axis.manual.fast = speeds.manual;
                              binding.axis.manual.setup_velocity = speeds.setup;
                          }
                          config.axis_groups[0].setup_velocity = speeds.tool;
                      }},
          tool_limit(speeds.tool > 0 ? speeds.tool : 250) {
        m.each_cycle = [this] { look(); };
        EXPECT_TRUE(m.up());
        EXPECT_TRUE(m.until(
            [&] { return std::all_of(joints.begin(), joints.end(), [&](const char* joint) { return m.axis(joint).online; }); }, 5s));
        const auto powered = order(a, CommandKind::enable, "all");
        EXPECT_TRUE(powered.accepted()) << powered.error.text();
        EXPECT_TRUE(m.until(
            [&] { return m.axis("wrist").powered && m.axis("shoulder").powered && m.axis("elbow").powered && m.axis("lift").powered; },
            3s));
        for (const auto* joint : joints) {
            EXPECT_TRUE(order(a, CommandKind::home, joint).accepted());
            EXPECT_TRUE(m.until([&] { return m.axis(joint).homed; }, 2s));
        }
        m.run(10ms);
        const auto enabled = order(a, CommandKind::group_enable, "arm");
        EXPECT_TRUE(enabled.accepted()) << enabled.error.what;
    }

    static hmi::CommandRequest jog_of(const Given& given) {
        return jog_request_of("arm", given.frame, given.direction, given.velocity, given.distance, given.press);
    }
    hmi::CommandReply jog(Given given, std::optional<hmi::ClientId> client = {}) {
        const auto who = client.value_or(a);
        // It is held from when it is taken on, which is before the answer comes.
        const auto before = held_at;
        if (given.velocity != 0) held_at = m.now();
        const auto answer = reply(who, send(jog_of(given), who));
        if (!answer.accepted()) held_at = before;
        else if (given.velocity != 0) held_at = m.now();
        return answer;
    }
    /// Renewed each 50 ms. The last answer.
    hmi::CommandReply hold(Given given, Duration time) {
        given.press = false;
        hmi::CommandReply last;
        for (auto end = m.now() + time; m.now() < end;) {
            last = jog(given);
            if (!last.accepted()) return last;
            for (auto next = m.now() + 50ms; m.now() < next && m.now() < end;) step();
        }
        return last;
    }
    hmi::CommandReply let_go(std::optional<hmi::ClientId> client = {}) { return jog({"mcs", "", 0, 0, false}, client); }

    bool stands() {
        for (const auto* joint : joints)
            if (m.axis(joint).set_velocity != 0 || m.axis(joint).active != 0) return false;
        return true;
    }
    double at(const std::string& joint) { return m.axis(joint).set_position; }
    /// To where an MCS jog has room: off the stretched arm.
    void bend() {
        ASSERT_TRUE(jog({"acs", "elbow+", 1, 60}).accepted());
        ASSERT_TRUE(hold({"acs", "elbow+", 1, 60}, 3s).accepted());
        ASSERT_TRUE(let_go().accepted());
        ASSERT_TRUE(until([&] { return stands(); }, 1s));
        ASSERT_NEAR(at("elbow"), 60, 1e-9);
    }

    double tool_limit;                ///< mm/s
    double fastest_tool = 0;          ///< mm/s since it was set to 0
    std::optional<Instant> held_at;   ///< the newest accepted press, renewal or own motion of an axis
    std::optional<Instant> setup_at;  ///< since when the machine is in set-up mode
    bool watches_hand = false;

private:
    struct Place {
        double x, y, z;
    };
    /// Two links of 200 and 150 mm in the plane, and the lift (config/machines/scara.yaml).
    Place tool() {
        constexpr double degree = std::numbers::pi / 180;
        const double one = at("shoulder") * degree, two = one + at("elbow") * degree;
        return {200 * std::cos(one) + 150 * std::cos(two), 200 * std::sin(one) + 150 * std::sin(two), at("lift")};
    }
    void look() {
        const auto& snapshot = m.snapshot();
        if (snapshot.mode != Mode::setup) setup_at.reset();
        else if (!setup_at) setup_at = m.now();
        const auto place = tool();
        if (last_) {
            const double speed = std::hypot(place.x - last_->x, place.y - last_->y, place.z - last_->z) / 1e-3;
            fastest_tool = std::max(fastest_tool, speed);
            // A chord is no longer than its arc. What was on the way when the mode was entered comes to rest first.
            if (setup_at && m.now() - *setup_at > longest_ramp) {
                EXPECT_LE(speed, tool_limit * (1 + 1e-6)) << "the tool in set-up mode";
            }
        }
        last_ = place;
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const auto& axis = m.axis(joints[i]);
            const auto& limits = m.config().axes[i].axis.limits;
            constexpr double t = 1e-3;
            auto& before = before_[i];
            if (before.known) {
                EXPECT_LE(std::abs(axis.set_velocity), limits.velocity * (1 + 1e-6)) << joints[i];
                EXPECT_LE(std::abs(axis.set_acceleration), limits.acceleration * (1 + 1e-6)) << joints[i];
                EXPECT_LE(std::abs(axis.set_acceleration - before.acceleration), limits.jerk * t * (1 + 1e-3) + 1e-6) << joints[i];
                EXPECT_LE(std::abs(axis.set_velocity - before.velocity - t * (axis.set_acceleration + before.acceleration) / 2),
                          limits.jerk * t * t / 2 + 1e-9)
                    << joints[i];
                if (axis.homed && before.homed && axis.powered && before.powered) {  // without power it follows the motor
                    EXPECT_LE(std::abs(axis.set_position - before.position - t * (axis.set_velocity + before.velocity) / 2),
                              limits.jerk * t * t * t / 4 + 1e-9)
                        << joints[i];
                }
            }
            before = {axis.set_position, axis.set_velocity, axis.set_acceleration, axis.homed, axis.powered, true};
        }
        if (watches_hand && !stands()) {
            const auto lease = m.config().axes[0].axis.patience.jog_lease;
            EXPECT_TRUE(held_at && m.now() - *held_at <= lease + longest_ramp) << "it moves, and nobody holds it";
        }
    }
    struct Before {
        double position = 0, velocity = 0, acceleration = 0;
        bool homed = false, powered = false, known = false;
    };
    std::array<Before, 4> before_{};
    std::optional<Place> last_;
};

}  // namespace taktwerk::group_hand
