#pragma once
// Two persons at any arm of config/machines/, through the gateway, with a tool that stands far off the flange. In every cycle, whatever anybody does: set-points
// are continuous and inside the limits; in set-up mode the tool (arms_by_hand.hpp) is within its velocity as long as the group moves it; nothing moves by
// a hand that is not there; and what is shown of the group is so.

#include <algorithm>
#include <map>
#include <optional>

#include "tests/group_hand/arms_by_hand.hpp"
#include "tests/group_hand/gateway_hand.hpp"

namespace taktwerk::group_hand {

struct ArmSpeeds {
    double manual = 60, setup = 40;  ///< u/s, of each axis
    double tool = 0;                 ///< mm/s in set-up mode; 0: as without a word
};

class AnyArmRig : public GatewayHand {
public:
    /// Of a hand that is taken away: the lease of 200 ms, the planner's lead, and the slowest ramp on a path of these machines.
    static constexpr auto longest_stop = 1s;

    explicit AnyArmRig(MachineArm of, const ArmSpeeds& speeds = {}, Mode start = Mode::manual)
        : GatewayHand{of.machine,
                      [&](runtime::MachineConfig& config) {
                          config.start_mode = start;
                          config.simulation.events.clear();
                          for (auto& binding : config.axes) {
                              if (std::find(of.joints.begin(), of.joints.end(), binding.axis.name) == of.joints.end()) continue;
                              binding.axis.manual = {5, speeds.manual, speeds.setup};
                          }
                          auto& group = config.axis_groups[0];
                          group.setup_velocity = speeds.tool;
                          EXPECT_TRUE(
                              group.equipment.tools.define(1, {.frame = {of.tool[0], of.tool[1], of.tool[2], 0, 0, 0}, .body = {}}));
                          group.equipment.selected_tool = 1;
                      }},
          arm{std::move(of)},
          tool_limit(speeds.tool > 0 ? speeds.tool : 250) {
        for (std::size_t i = 0; i < m.config().axes.size(); ++i)
            for (const auto& joint : arm.joints)
                if (m.config().axes[i].axis.name == joint) places_.push_back(i);
        before_.resize(places_.size());
        m.each_cycle = [this] { look(); };
        EXPECT_TRUE(m.up());
        step();
        EXPECT_TRUE(until([&] { return all([](const auto& axis) { return axis.online; }); }, 10s));
    }

    /// What was asked last, and what came of it: of a failure.
    [[nodiscard]] std::string history() const {
        std::string all;
        for (auto entry = asked_.begin(); entry != asked_.end(); ++entry) {
            if (entry->first.second + 24 < sequence) continue;
            const auto& r = entry->second;
            const auto answer = replies.find(entry->first);
            const auto* word = hmi::find_command(r.kind);
            all += "\n  " + std::to_string(asked_at_.at(entry->first.second).time_since_epoch().count() / 1'000'000) + " ms #" +
                   std::to_string(entry->first.second) + " client " + std::to_string(entry->first.first) + ": " +
                   (word ? std::string(word->word) : "?") + " " + r.target + " " + std::to_string(r.value) + (r.press ? " press" : "") +
                   (r.kind == CommandKind::mode ? " mode " + std::to_string(static_cast<int>(r.mode)) : "") + " " + r.group_jog.frame +
                   " " + r.group_jog.direction + " " + std::to_string(r.group_jog.distance) + " -> " +
                   (answer == replies.end()     ? "-"
                    : answer->second.accepted() ? "accepted"
                                                : answer->second.error.text());
        }
        return all;
    }
    [[nodiscard]] hmi::CommandRequest jog_request(const std::string& frame, const std::string& direction, double velocity = 1,
                                                  double distance = 0, bool press = true) const {
        return jog_request_of(arm.group, frame, direction, velocity, distance, press);
    }
    hmi::CommandReply jog(const hmi::CommandRequest& request, hmi::ClientId client) { return reply(client, send(request, client)); }
    /// Pressed, then renewed each 50 ms; until it is refused, or for so long.
    hmi::CommandReply hold(hmi::CommandRequest request, Duration time, hmi::ClientId client) {
        hmi::CommandReply last;
        for (auto end = m.now() + time; m.now() < end; request.press = false) {
            last = jog(request, client);
            if (!last.accepted()) return last;
            for (auto next = m.now() + 50ms; m.now() < next && m.now() < end;) step();
        }
        return last;
    }
    hmi::CommandReply let_go(hmi::ClientId client) { return jog(jog_request("mcs", "", 0, 0, false), client); }
    void lose(hmi::ClientId& client) {
        gateway.close(client);
        client = open("panel anew");
    }

    /// Whatever was: powered, homed, enabled, at rest, in this mode.
    void make_ready(Mode wanted = Mode::manual) {
        if (arm.emergency) m.world().set_input("estop_ok", true);
        (void)mode(wanted);
        EXPECT_TRUE(until([&] { return stands(); }, 5s)) << arm.machine << ": it comes to rest";
        run(20ms);
        (void)order(a, CommandKind::override_velocity, "all", 1);
        (void)order(a, CommandKind::group_override, arm.group, 1);
        auto release = hmi::CommandRequest{};  // what somebody has taken in the name of commissioning
        release.kind = CommandKind::release_control;
        release.commissioning = true;
        for (const auto& joint : arm.joints) {
            release.target = joint;
            (void)reply(a, send(release, a));
        }
        (void)order(a, CommandKind::acknowledge, "");
        EXPECT_TRUE(until([&] { return all([](const auto& axis) { return axis.online; }); }, 10s));
        for (int tries = 0; tries < 3 && !all([](const auto& axis) { return axis.state != axes::AxisState::ErrorStop; }); ++tries) {
            (void)order(a, CommandKind::reset, "");
            (void)until([&] { return all([](const auto& axis) { return axis.state != axes::AxisState::ErrorStop; }); }, 2s);
        }
        for (const auto& joint : arm.joints) (void)order(a, CommandKind::enable, joint);
        EXPECT_TRUE(until([&] { return all([](const auto& axis) { return axis.powered; }); }, 5s))
            << arm.machine << m.alarms() << history();
        for (const auto& joint : arm.joints) {
            if (m.axis(joint).homed) continue;
            (void)order(a, CommandKind::home, joint);
            EXPECT_TRUE(until([&] { return m.axis(joint).homed; }, 5s)) << joint << m.alarms();
        }
        run(20ms);
        (void)order(a, CommandKind::group_enable, arm.group);  // of one that was disabled with its error: that is back then
        (void)order(a, CommandKind::group_reset, arm.group);
        run(20ms);
        (void)order(a, CommandKind::group_enable, arm.group);
        run(20ms);
        placed_ = true;
        EXPECT_EQ(seen().state, axes::GroupState::GroupStandby) << arm.machine << " error " << seen().error << m.alarms() << history();
    }

    bool stands() {
        for (const auto& joint : arm.joints)
            if (const auto& axis = m.axis(joint); axis.powered && (axis.set_velocity != 0 || axis.active != 0)) return false;
        return true;
    }
    Point tool() {
        std::vector<double> q;
        for (const auto& joint : arm.joints) q.push_back(m.axis(joint).set_position);
        return arm.place(q, arm.tool);
    }

    MachineArm arm;
    double tool_limit;         ///< mm/s
    double fastest_tool = 0;   ///< mm/s in set-up mode, since it was set to 0
    bool watches_hand = true;  ///< outside automatic mode: nothing moves without a hand
    bool own_tool = true;      ///< nobody else has selected one

private:
    template <class Is>
    bool all(const Is& is) {
        return std::all_of(arm.joints.begin(), arm.joints.end(), [&](const auto& joint) { return is(m.axis(joint)); });
    }
    void sends(const hmi::CommandRequest& request) override {
        asked_[{request.client, request.sequence}] = request;
        if ((request.kind == CommandKind::group_jog || request.kind == CommandKind::jog) && request.value != 0) asked_hold_ = m.now();
        asked_at_[request.sequence] = m.now();
    }
    void answered(const hmi::CommandReply& reply) override {
        const auto sent = asked_.find({reply.client, reply.sequence});
        if (sent != asked_.end() && reply.accepted()) took(sent->second);
    }
    void took(const hmi::CommandRequest& request) {
        if ((request.kind == CommandKind::group_jog || request.kind == CommandKind::jog) && request.value != 0) held_at_ = m.now();
    }
    [[nodiscard]] bool moves_alone(const axes::AxisView& axis) const {
        return axis.state != axes::AxisState::SynchronizedMotion && axis.set_velocity != 0;
    }

    void look() {
        const auto& snapshot = m.snapshot();
        const auto& group = seen();
        const bool by_hand = snapshot.mode != Mode::automatic;
        if (!by_hand) own_tool = false;  // a program may select another
        if (!by_hand) manual_at_.reset();
        else if (!manual_at_) manual_at_ = m.now();
        bool alone = false, moves = false, goes = false, powered = true, led = true, any_led = false;
        for (std::size_t i = 0; i < places_.size(); ++i) {
            const auto& axis = snapshot.axes[places_[i]];
            look_at(i, axis);
            powered = powered && axis.powered;
            alone = alone || (axis.powered && moves_alone(axis));
            moves = moves || (axis.powered && axis.set_velocity != 0);
            // Moves and searches go to their end by themselves.
            goes = goes || axis.active_kind == axes::CommandKind::move_absolute || axis.active_kind == axes::CommandKind::home ||
                   axis.state == axes::AxisState::Homing;
            const bool synchronized = axis.state == axes::AxisState::SynchronizedMotion;
            led = led && synchronized;
            any_led = any_led || synchronized;
        }
        if (group.state == axes::GroupState::GroupMoving) {
            EXPECT_TRUE(led) << arm.machine << ": it moves, and not all of its axes with it";
        }
        if (group.state == axes::GroupState::GroupStandby || group.state == axes::GroupState::GroupDisabled) {
            EXPECT_FALSE(any_led) << arm.machine << ": it stands, and an axis goes with it";
        }
        look_at_tool(snapshot.mode == Mode::setup, powered && !alone);
        if (goes) own_at_ = m.now();
        const auto since = [&](const std::optional<Instant>& at) { return at && m.now() - *at <= longest_stop; };
        if (watches_hand && by_hand && moves && !since(held_at_) && !since(own_at_) && !since(manual_at_) &&
            !(asked_hold_ && m.now() - *asked_hold_ <= 5ms)) {  // its answer is on the way
            ADD_FAILURE() << arm.machine << ": it moves at " << m.now().time_since_epoch().count() << " and nobody holds it, state "
                          << static_cast<int>(group.state) << " command " << static_cast<int>(group.active_kind) << history();
            watches_hand = false;
        }
    }

    void look_at_tool(bool setup, bool together) {
        const auto& group = seen();
        const Point place = tool();
        if (placed_ && were_together_ && own_tool && group.tool.known && together) {
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(group.tool.set[k], place[k], 1e-6)
                    << arm.machine << ": where the tool is, told and worked out " << static_cast<int>(group.state) << " at "
                    << m.now().time_since_epoch().count();
        }
        // What was on the way when the mode was entered comes to rest first.
        const bool moving = group.state == axes::GroupState::GroupMoving;
        if (!setup) calm_ = false;
        else if (!moving && together) calm_ = true;
        EXPECT_EQ(group.along.tool_limit, setup ? tool_limit : 0);
        if (tool_ && own_tool && together && were_together_) {
            const double speed = std::hypot(place[0] - (*tool_)[0], place[1] - (*tool_)[1], place[2] - (*tool_)[2]) / 1e-3;
            // A chord is no longer than its arc.
            if (calm_ && moving) {
                fastest_tool = std::max(fastest_tool, speed);
                EXPECT_LE(speed, tool_limit * (1 + 1e-6)) << arm.machine << ": the tool in set-up mode";
                if (group.along.limiter == axes::PathLimiter::setup_velocity) {
                    EXPECT_GE(speed, 0.9 * tool_limit) << "told is so";
                }
            }
        }
        tool_ = place;
        were_together_ = together;
    }

    void look_at(std::size_t i, const axes::AxisView& axis) {
        constexpr double t = 1e-3;
        const auto& limits = m.config().axes[places_[i]].axis.limits;
        const auto& name = arm.joints[i];
        auto& before = before_[i];
        const double ramp = std::max({limits.acceleration, limits.deceleration, limits.stop_deceleration});
        const double jerk = std::max(limits.jerk, limits.stop_jerk);
        if (before.known && axis.powered && before.powered && axis.homed == before.homed) {
            EXPECT_LE(std::abs(axis.set_velocity), limits.velocity * (1 + 1e-6)) << name;
            EXPECT_LE(std::abs(axis.set_acceleration), ramp * (1 + 1e-6)) << name;
            EXPECT_LE(std::abs(axis.set_acceleration - before.acceleration), jerk * t * (1 + 1e-3) + 1e-6) << name;
            EXPECT_LE(std::abs(axis.set_velocity - before.velocity - t * (axis.set_acceleration + before.acceleration) / 2),
                      jerk * t * t / 2 + 1e-9)
                << name;
            EXPECT_LE(std::abs(axis.set_position - before.position - t * (axis.set_velocity + before.velocity) / 2),
                      jerk * t * t * t / 4 + 1e-9)
                << name;
            // Where its power came back it is where the motor was, which may be a hair outside; from there it goes back alone.
            if (axis.homed && axis.set_position > before.position) {
                EXPECT_LE(axis.set_position, limits.position_max + 1e-9) << name;
            }
            if (axis.homed && axis.set_position < before.position) {
                EXPECT_GE(axis.set_position, limits.position_min - 1e-9) << name;
            }
        }
        before = {axis.set_position, axis.set_velocity, axis.set_acceleration, axis.homed, axis.powered, true};
    }

    struct Before {
        double position = 0, velocity = 0, acceleration = 0;
        bool homed = false, powered = false, known = false;
    };
    std::vector<std::size_t> places_;  // of its joints among the axes
    std::vector<Before> before_;
    std::optional<Point> tool_;
    bool placed_ = false;  // what was searched has been found: places do not change by themselves any more
    bool were_together_ = false, calm_ = false;
    std::optional<Instant> asked_hold_, held_at_, own_at_, manual_at_;
    std::map<std::pair<hmi::ClientId, std::uint64_t>, hmi::CommandRequest> asked_;
    std::map<std::uint64_t, Instant> asked_at_;
};

}  // namespace taktwerk::group_hand
