// What becomes of a group in the middle of an arc, whatever happens to the machine: each row of the tables of docs/motion/group-ends.md, on the gantry of
// dispensing.yaml and on the delta of
// delta-picker.yaml while it goes with its belt. Beside what a row says, the oracles of every axis look on in each cycle: set-points are continuous in
// place, velocity and acceleration, and what a drive is told is what its axis shows.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include "axes/axis/alarms.hpp"
#include "axes/axis/error_table.hpp"
#include "tests/programs/examples/watched_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::group_ends {
namespace {

using namespace std::chrono_literals;
using axes::ErrorId;
using axes::GroupState;
using runtime::OperatorAction;
using testing::WatchedMachine;

/// What a block has shown at last.
enum class End : std::uint8_t { none, done, aborted, error };

/// An arc with a line behind it, on a table or on a belt; whatever becomes of them, it does nothing until `again`.
template <bool on_belt>
class Draws : public Program {
    static constexpr std::size_t most = 4;
    axes::GroupRef group_;
    std::array<AxisRef, most> axes_;
    std::size_t count_ = 0;
    AxisRef belt_;
    fb::MC_GroupPower power_;
    std::array<fb::MC_Home, most> homes_;
    fb::MC_GroupEnable enable_;
    fb::MC_GroupReadStatus status_;
    fb::MC_MoveDirectAbsolute square_;
    fb::MC_MoveLinearAbsolute to_start_, line_;
    fb::MC_MoveCircularAbsolute arc_;
    fb::MC_Power belt_power_;
    fb::MC_MoveVelocity feed_;
    fb::MC_TrackConveyorBelt track_;
    bool again_ = false;
    int step_ = 0;
    std::int64_t arc_end_ = 0, arc_code_ = 0, line_end_ = 0, line_code_ = 0, rounds_ = 0;
    bool arc_active_ = false, arc_busy_ = false, line_busy_ = false;
    double reference_ = 0;

public:
    void declare(Declaration& d) override {
        group_ = d.axis_group(on_belt ? "delta" : "gantry");
        if (on_belt) belt_ = d.axis("belt");
        for (const char* name : on_belt ? std::initializer_list<const char*>{"arm1", "arm2", "arm3"}
                                        : std::initializer_list<const char*>{"near", "far", "across", "lift"})
            axes_[count_++] = d.axis(name);
        d.block("arc", arc_);
        d.block("line", line_);
        d.operator_switch("again", again_);
        d.monitor("rounds", rounds_);
        d.monitor("arc_active", arc_active_);
        d.monitor("arc_busy", arc_busy_);
        d.monitor("line_busy", line_busy_);
        d.monitor("arc_end", arc_end_);
        d.monitor("arc_code", arc_code_);
        d.monitor("line_end", line_end_);
        d.monitor("line_code", line_code_);
        d.monitor("reference", reference_);
        d.task<&Draws::scan>("main");
    }
    void start() override {
        again_ = false;
        step_ = 0;
        enable_.Execute = square_.Execute = to_start_.Execute = arc_.Execute = line_.Execute = track_.Execute = feed_.Execute = false;
    }
    void scan(TaskContext& ctx) {
        using namespace fb;
        for (auto* any : {&power_.AxesGroup, &enable_.AxesGroup, &status_.AxesGroup, &square_.AxesGroup, &to_start_.AxesGroup,
                          &arc_.AxesGroup, &line_.AxesGroup, &track_.AxesGroup})
            *any = group_;
        power_.Enable = status_.Enable = true;
        power_(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < count_; ++i) {
            homes_[i].Axis = axes_[i];
            homes_[i].Execute = power_.Status && !ctx.view(axes_[i])->homed;
            homes_[i](ctx);
            homed = homed && ctx.view(axes_[i])->homed && !homes_[i].Busy;
        }
        enable_.Execute = power_.Status && homed;
        enable_(ctx);
        status_(ctx);
        if (on_belt) {
            belt_power_.Axis = feed_.Axis = belt_;
            belt_power_.Enable = true;
            belt_power_(ctx);
            feed_.Velocity = 40;
            feed_.Execute = belt_power_.Status && step_ > 0;
            feed_(ctx);
        }
        if (step_ < 0) step_ = 0;  // the belt has seen a FALSE
        if (again_) step_ = -1, again_ = false;
        const bool stands =
            power_.Status && homed && (status_.GroupStandby || (on_belt && status_.GroupMoving)) && (!on_belt || belt_power_.Status);
        if (step_ == 0 && stands) step_ = 1;

        square_.CoordSystem = mcACS;
        square_.Position.A.Axes = on_belt ? AxisValues{20, 20, 20} : AxisValues{300, 300, 300, 0};
        square_.Velocity = on_belt ? 60 : 200;
        square_.Execute = step_ == 1;
        square_(ctx);
        if (square_.Done) step_ = 2;

        track_.ConveyorBelt = belt_;
        track_.ConveyorBeltOrigin = {.X = -60, .Y = -60, .Z = -850};
        track_.CoordSystem = mcPCS;
        track_.Execute = on_belt && step_ == 2 && feed_.InVelocity;
        if (on_belt) {
            if (step_ == 2) reference_ = ctx.view(belt_)->set_position;  // until the scan of the edge
            track_(ctx);
        }
        if (step_ == 2 && (!on_belt || track_.Done)) step_ = 3;

        // Half a circle of 150 mm about (500, 300); on the belt one of 40 mm about the part. By the tool's point.
        const MC_CoordSystem frame = on_belt ? mcPCS : mcMCS;
        to_start_.CoordSystem = arc_.CoordSystem = line_.CoordSystem = frame;
        const double r = on_belt ? 40 : 150;
        const MC_CART_REF middle = on_belt ? MC_CART_REF{} : MC_CART_REF{.X = 500, .Y = 300, .Z = -60};
        to_start_.Position.C.Tcp = arc_.AuxPoint.C.Tcp = arc_.EndPoint.C.Tcp = line_.Position.C.Tcp = middle;
        to_start_.Position.C.Tcp.X += r;
        arc_.EndPoint.C.Tcp.X -= r;
        line_.Position.C.Tcp.X -= r;
        line_.Position.C.Tcp.Y -= r;
        arc_.CircMode = mcCENTER;
        arc_.PathChoice = mcCounterClockwise;
        to_start_.Velocity = arc_.Velocity = line_.Velocity = on_belt ? 80 : 200;
        to_start_.Execute = step_ >= 3 && step_ < 5;
        arc_.BufferMode = line_.BufferMode = mcBuffered;
        arc_.Execute = line_.Execute = step_ >= 3 && step_ < 5;
        if (to_start_.Execute && step_ == 3) arc_end_ = arc_code_ = line_end_ = line_code_ = 0, step_ = 4;
        to_start_(ctx);
        arc_(ctx);
        line_(ctx);
        see(arc_, arc_end_, arc_code_);
        see(line_, line_end_, line_code_);
        arc_active_ = arc_.Active;
        arc_busy_ = arc_.Busy;
        line_busy_ = line_.Busy;
        if (step_ == 4 && line_.Done) ++rounds_;
        if (step_ == 4 && line_end_ != 0) step_ = 5;
    }

private:
    template <class Block>
    static void see(const Block& block, std::int64_t& end, std::int64_t& code) {
        if (end != 0) return;
        if (block.Done) end = static_cast<std::int64_t>(End::done);
        if (block.CommandAborted) end = static_cast<std::int64_t>(End::aborted);
        if (block.Error) end = static_cast<std::int64_t>(End::error), code = static_cast<std::int64_t>(block.ErrorID);
    }
};

/// The machine in the middle of its arc, and what is seen of it from there on.
class Arc {
public:
    explicit Arc(bool on_belt)
        : belt(on_belt),
          m(on_belt ? "delta-picker" : "dispensing",
            on_belt ? runtime::testing::entry_of<Draws<true>> : runtime::testing::entry_of<Draws<false>>) {
        EXPECT_TRUE(m.up());
        EXPECT_TRUE(m.until([&] { return m.variable("arc_active") != 0 && m.group().along.progress > 0.4 && off() < 1e-6; }, 30s))
            << m.alarms() << m.variable("arc_end") << ' ' << m.variable("arc_code") << " off " << off();
    }
    [[nodiscard]] std::string shown(const std::string& block) {
        const auto end = static_cast<End>(static_cast<int>(m.variable(block + "_end")));
        switch (end) {
            case End::none: return m.variable(block + "_busy") != 0 ? "Busy" : "nothing";
            case End::done: return "Done";
            case End::aborted: return "CommandAborted";
            case End::error: return "Error `" + word(static_cast<std::uint16_t>(m.variable(block + "_code"))) + "`";
        }
        return "";
    }
    [[nodiscard]] static std::string word(std::uint16_t code) {
        if (code == 0) return "none";
        if (const auto* alarm = find_alarm(axes::axis_alarms, code)) return std::string(alarm->name);
        const auto* text = axes::find_error(static_cast<ErrorId>(code));
        return text != nullptr ? std::string(text->name) : "unknown";
    }
    /// How far the set-points are from the circle; of the belt's, about the part.
    [[nodiscard]] double off() {
        const auto& tool = m.group().tool.set;
        if (!belt) return std::abs(std::hypot(tool[0] - 500, tool[1] - 300) - 150);
        const double middle = -60 + m.view("belt").set_position - m.variable("reference");
        return std::abs(std::hypot(tool[0] - middle, tool[1] + 60) - 40);
    }
    [[nodiscard]] std::vector<std::string> members() const {
        return belt ? std::vector<std::string>{"arm1", "arm2", "arm3"} : std::vector<std::string>{"near", "far", "across", "lift"};
    }
    [[nodiscard]] bool all_enabled() {
        for (const auto& name : members())
            if (!m.view(name).powered || m.view(name).drive_state != axes::PowerState::enabled) return false;
        return true;
    }
    /// From the blow on.
    void watch(Duration time) {
        m.until(
            [&] {
                if (all_enabled()) {
                    worst_off = std::max(worst_off, off());
                    if (!belt) askew = std::max(askew, std::abs(m.view("near").set_position - m.view("far").set_position));
                }
                return false;
            },
            time);
    }
    [[nodiscard]] std::vector<double> places() {
        std::vector<double> at;
        for (const auto& name : members()) at.push_back(m.place(name));
        return at;
    }
    const bool belt;
    WatchedMachine m;
    double worst_off = 0, askew = 0;  ///< mm
};

enum class Path : std::uint8_t { kept, others_keep_it, left };

struct Row {
    std::string name;
    std::function<void(WatchedMachine&)> strike, heal;
    std::string state, error, arc, line;
    Path path;
    std::string on;  ///< what is needed to go on, in this order: reset, automatic, start, continue, again
};

void order(WatchedMachine& m, OperatorAction action) { EXPECT_EQ(m.command(action, 0).answer, runtime::Answer::accepted); }
void stall(WatchedMachine& m, Duration length) {  // as tests/whole_machine: the computer does nothing for so long, and the world goes on
    m.clock.advance(length);
    m.world.network().advance(m.clock.now());
    m.world.apply_events(m.clock.now());
    const auto now = m.clock.now();
    m.machine->cycle({now, now, static_cast<std::uint32_t>(length / 1ms)});
    m.machine->run_slow_tasks();
    m.machine->service(now);
    if (m.runner->drain) m.runner->drain();
    m.runner->after_cycle(now);
}
void mains(WatchedMachine& m, const std::string& axis, bool on) {
    runtime::SimulationEvent event;
    event.kind = runtime::SimulationEvent::Kind::main_power;
    event.target = axis;
    event.value = on ? 1 : 0;
    m.world.happen(event);
}
void none(WatchedMachine&) {}

std::vector<Row> rows(bool belt) {
    const std::string axis = belt ? "arm2" : "across", slave = belt ? "arm2_drive" : "carriage_drive";
    const std::string others = "Error `aborted_by_axis_error`";
    const auto error = [](const std::string& code) { return "Error `" + code + "`"; };
    std::vector<Row> all{
        {"a member's drive faults", [=](auto& m) { m.world.drive(axis)->raise(0x2310); }, none, "GroupErrorStop", "drive_fault",
         error("drive_fault"), others, Path::others_keep_it, "reset, again"},
        {"a member loses its mains", [=](auto& m) { mains(m, axis, false); }, [=](auto& m) { mains(m, axis, true); }, "GroupErrorStop",
         "drive_fault", error("drive_fault"), others, Path::others_keep_it, "reset, again"},
        {"a member's following error", [=](auto& m) { m.world.drive(axis)->jam(true); }, [=](auto& m) { m.world.drive(axis)->jam(false); },
         "GroupErrorStop", "following_error", error("following_error"), others, Path::others_keep_it, "reset, again"},
        {"a slave is lost", [=](auto& m) { m.world.set_slave_power(slave, false); }, [=](auto& m) { m.world.set_slave_power(slave, true); },
         "GroupErrorStop", "stopped_by_machine", error("stopped_by_machine"), others, Path::left, "reset, start, again"},
        {"the cable is cut", [=](auto& m) { m.world.transport().faults.link_down = true; },
         [](auto& m) { m.world.transport().faults.link_down = false; }, "GroupErrorStop", "stopped_by_machine", error("stopped_by_machine"),
         others, Path::left, "reset, start, again"},
        {"the computer stalls", [](auto& m) { stall(m, 20ms); }, none, "GroupErrorStop", "stopped_by_machine", error("stopped_by_machine"),
         others, Path::left, "reset, again"},
        {"emergency stop", [](auto& m) { m.world.set_input("estop_ok", false); }, [](auto& m) { m.world.set_input("estop_ok", true); },
         "GroupErrorStop", "emergency_stop", error("emergency_stop"), others, Path::left, "reset, start, again"},
        {"the program is stopped", [](auto& m) { order(m, OperatorAction::program_stop); }, none, "GroupStandby", "none", "Busy", "Busy",
         Path::kept, "start"},
        {"a person stops everything", [](auto& m) { (void)m.machine->request_stop(0xFFFF); }, none, "GroupStandby", "none",
         "CommandAborted", "CommandAborted", Path::kept, "again"},
        {"a person halts the group", [](auto& m) { order(m, OperatorAction::group_halt); }, none, "GroupStandby", "none", "CommandAborted",
         "CommandAborted", Path::kept, "again"},
        {"a person interrupts the group", [](auto& m) { order(m, OperatorAction::group_interrupt); }, none, "GroupStandby", "none", "Busy",
         "Busy", Path::kept, "continue"},
        {"the machine leaves automatic", [](auto& m) { EXPECT_EQ(m.mode(runtime::Mode::manual).answer, runtime::Answer::accepted); }, none,
         "GroupErrorStop", "member_left", "Busy", "Busy", Path::left, "reset, automatic, start"},
    };
    if (!belt) return all;
    // So slow an arm that is held is seen by its drive before the window is: that is the row above.
    std::erase_if(all, [](const Row& row) { return row.name == "a member's following error"; });
    for (auto& row : all) {
        const bool person = row.name.starts_with("a person");
        if (person) row.state = "GroupMoving";  // on the part the group stands, and goes with it
        else row.path = Path::left;             // the frame is let go
    }
    all.push_back({"the belt's drive faults", [](auto& m) { m.world.drive("belt")->raise(0x2310); }, none, "GroupErrorStop", "frame_lost",
                   error("frame_lost"), others, Path::left, "reset, again"});
    return all;
}

/// Nothing stands any more but that the program waits for its start, behind an emergency stop.
bool only_waits(WatchedMachine& m) {
    const auto& snapshot = m.state();
    for (std::size_t i = 0; i < snapshot.alarm_count; ++i)
        if (m.machine->describe(snapshot.alarms[i].fact).name != "program_waits") return false;
    return true;
}

void go_on(Arc& arc, const Row& row) {
    auto& m = arc.m;
    const auto wanted = [&](const char* what) { return row.on.find(what) != std::string::npos; };
    if (wanted("reset")) {
        EXPECT_TRUE(m.reset_until([&] { return m.group().state != GroupState::GroupErrorStop && only_waits(m); }, 60s)) << m.alarms();
    }
    if (wanted("automatic")) {
        EXPECT_EQ(m.mode(runtime::Mode::automatic).answer, runtime::Answer::accepted);
    }
    if (wanted("start")) order(m, OperatorAction::program_start);
    if (wanted("continue")) order(m, OperatorAction::group_continue);
    if (wanted("again")) m.set_switch("again", true);
}

const std::string page = TAKTWERK_SOURCE_DIR "/docs/motion/group-ends.md";

void happens(bool belt, const Row& row) {
    SCOPED_TRACE(row.name);
    Arc arc{belt};
    auto& m = arc.m;
    const auto rounds = m.variable("rounds");
    row.strike(m);
    arc.watch(2s);
    EXPECT_EQ(axes::name(m.group().state), row.state) << m.alarms();
    EXPECT_EQ(Arc::word(m.group().error), row.error) << m.alarms();
    EXPECT_EQ(arc.shown("arc"), row.arc);
    EXPECT_EQ(arc.shown("line"), row.line);
    if (row.path == Path::kept) {
        EXPECT_LE(arc.worst_off, belt ? 1e-4 : 1e-6) << "mm from the circle; a belt that stops is followed to jerk * T^3 / 6";
    }
    if (row.path != Path::left && !belt) {
        EXPECT_LE(arc.askew, 1e-9) << "mm: both ends of the beam are well, and go the same way";
    }
    // Whoever is to go on says so: nothing begins by itself.
    row.heal(m);
    const auto before = arc.places();
    arc.m.run(1s);
    const auto after = arc.places();
    for (std::size_t i = 0; i < before.size() && row.state != "GroupMoving"; ++i)
        EXPECT_NEAR(after[i], before[i], 0.05) << arc.members()[i];

    go_on(arc, row);
    EXPECT_TRUE(m.until([&] { return m.variable("rounds") > rounds; }, 60s)) << m.alarms() << arc.shown("arc") << arc.shown("line");
    EXPECT_EQ(m.alarms(), "");

    std::ifstream file{page};
    std::stringstream text;
    text << file.rdbuf();
    const std::string says = "| " + row.name + " | " + row.state + " | " + (row.error == "none" ? "" : "`" + row.error + "`") +
                             (row.error == "none" ? "| " : " | ") + row.arc + " | " + row.line + " | ";
    EXPECT_NE(text.str().find(says), std::string::npos) << page << " lacks: " << says;
}

TEST(GroupEnds, InTheMiddleOfAnArc) {
    for (const auto& row : rows(false)) happens(false, row);
}
TEST(GroupEnds, WhileItGoesWithABelt) {
    for (const auto& row : rows(true)) happens(true, row);
}

}  // namespace
}  // namespace taktwerk::group_ends
