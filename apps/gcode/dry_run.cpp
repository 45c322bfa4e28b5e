#include "apps/gcode/dry_run.hpp"

#include <algorithm>
#include <cmath>

#include "core/clock.hpp"
#include "core/math.hpp"
#include "fb_library/groups/group_administration.hpp"
#include "fb_library/groups/group_limits.hpp"
#include "fb_library/groups/group_paths.hpp"
#include "fb_library/groups/group_state_blocks.hpp"
#include "fb_library/groups/group_stops.hpp"
#include "fb_library/motion/home.hpp"
#include "hmi_bridge/words/place_text.hpp"
#include "programs/api/entry.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/run/virtual_runner.hpp"
#include "runtime/tasks/program_library.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;

/// Programs are made without arguments: what this one is to do, and what came of it. One run at a time.
struct Job {
    const DryRunWish* wish = nullptr;
    std::vector<std::string> members;
    DryRunOutcome out;
    bool over = false;
    std::string trouble;
};
Job job;

/// Powers, homes, enables, selects, goes, and says yes to whatever the path asks for.
class Goes final : public Program {
public:
    void declare(Declaration& d) override {
        for (const auto& name : job.members) axes_.push_back(d.axis(name));
        homes_.resize(axes_.size());
        group_ = d.axis_group(job.wish->group);
        path_ = d.path("program");
        d.task<&Goes::scan>("main");
    }
    void scan(TaskContext& ctx) {
        for (auto* group :
             {&power_.AxesGroup, &enable_.AxesGroup, &override_.AxesGroup, &select_.AxesGroup, &move_.AxesGroup, &asked_.AxesGroup})
            *group = group_;
        power_.Enable = override_.Enable = asked_.Enable = true;
        power_(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < axes_.size(); ++i) {
            homes_[i].Axis = axes_[i];
            homes_[i].Execute = power_.Status && !ctx.view(axes_[i])->homed;
            homes_[i](ctx);
            homed = homed && ctx.view(axes_[i])->homed && !homes_[i].Busy;
            if (homes_[i].Error) fail("axis '" + job.members[i] + "' is not homed", homes_[i].ErrorID);
        }
        enable_.Execute = power_.Status && homed;
        enable_(ctx);
        override_.VelFactor = job.wish->override_factor;
        override_(ctx);
        select_.PathDescription = {path_, job.wish->options};
        select_.Execute = enable_.Done || select_.Execute;
        select_(ctx);
        move_.PathData = select_.PathData;
        move_.Execute = select_.Done || move_.Execute;
        move_(ctx);
        asked_.Acknowledge = asked_.Waits && !asked_.Acknowledge;
        asked_(ctx);
        const auto& view = *ctx.groups->view(group_);
        look(ctx, view);
        job.out.done = move_.Done;
        if (select_.Error || move_.Error || move_.CommandAborted) {
            job.out.place = view.path.place;
            if (job.out.place.error == axes::ErrorId::none) job.out.place.error = select_.Error ? select_.ErrorID : move_.ErrorID;
        }
        job.over = job.over || move_.Done || select_.Error || move_.Error || move_.CommandAborted;
    }

private:
    static void fail(std::string what, axes::ErrorId why) {
        if (job.over) return;
        job.over = true;
        job.trouble = std::move(what);
        job.out.place.error = why;
    }
    void look(const TaskContext& ctx, const axes::GroupView& view) {
        if (asked_.RequestID != seen_) job.out.requests.push_back({view.path.request, view.path.request.line, job.out.seconds});
        seen_ = asked_.RequestID;
        if (!move_.Active) return;
        const double period = to_seconds(ctx.period);
        const std::array<double, 3> at{view.tool_set[0], view.tool_set[1], view.tool_set[2]};
        if (job.out.seconds > 0) job.out.length += std::hypot(at[0] - last_[0], at[1] - last_[1], at[2] - last_[2]);
        last_ = at;
        job.out.seconds += period;
        const double velocity = std::hypot(view.tool_velocity[0], view.tool_velocity[1], view.tool_velocity[2]);
        job.out.fastest = std::max(job.out.fastest, velocity);
        if (velocity > 0) {
            job.out.moving += period;
            if (view.limiter == axes::PathLimiter::axis) job.out.at_limit[view.limiting_place] += period;
            if (view.limiter == axes::PathLimiter::command) job.out.at_feed += period;
        }
        if (job.wish->keeps_points) job.out.points.push_back({job.out.seconds, at, velocity, view.path.line});
    }

    std::vector<AxisRef> axes_;
    std::vector<fb::MC_Home> homes_;
    axes::GroupRef group_;
    axes::PathRef path_;
    fb::MC_GroupPower power_;
    fb::MC_GroupEnable enable_;
    fb::MC_GroupSetOverride override_;
    fb::MC_PathSelect select_;
    fb::MC_MovePath move_;
    fb::Path_Handshake asked_;
    std::array<double, 3> last_{};
    std::uint32_t seen_ = 0;
};

const ProgramEntry* entry() {
    static const ProgramEntry it{program_magic,
                                 sizeof(ProgramEntry),
                                 runtime::ProgramLibrary::expected_abi(),
                                 sdk_version,
                                 "gcode run",
                                 []() -> Program* { return new Goes; },
                                 [](Program* p) { delete p; }};
    return &it;
}

void use_own_program(runtime::MachineConfig& config) {
    config.programs.clear();
    config.tasks.clear();
    runtime::ProgramConfig program;
    program.name = "gcode_run";
    program.entry = entry;
    program.autostart = true;
    config.programs.push_back(std::move(program));
    runtime::TaskConfig task;
    task.name = "main";
    task.program = "gcode_run";
    config.tasks.push_back(std::move(task));
    config.start_mode = runtime::Mode::automatic;
}

}  // namespace

Result<DryRunOutcome> dry_run(runtime::MachineConfig config, const DryRunWish& wish) {
    math::set_stepping_thread_float_environment();
    job = {};
    job.wish = &wish;
    for (const auto& group : config.axis_groups)
        if (group.name == wish.group) job.members = group.members;
    use_own_program(config);
    VirtualClock clock{Instant{}};
    runtime::World world{config, clock.now()};
    auto built = runtime::Machine::build(std::move(config), world.bus(), world.serial().lines(), world.modbus().exchanges());
    if (auto* errors = std::get_if<1>(&built)) return std::move(errors->front());
    auto& machine = *std::get<0>(built);
    runtime::VirtualRunner runner{machine, world, clock};
    if (auto up = runner.bring_up(); !up) return up.error();
    (void)runner.run_until([] { return job.over; }, from_seconds(wish.most_seconds));
    const auto& groups = machine.layout().groups;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        auto place = job.out.place;
        place.line = 0;
        if (groups[i].name == wish.group) job.out.where = hmi::place_text(place, machine.layout(), i, hmi::members_of(machine.layout(), i));
    }
    runner.shut_down();
    if (!job.trouble.empty())
        return Error{"gcode.not_begun", "gcode run", job.trouble, "let the machine's own program run, simulated, and look at its alarms"};
    return std::move(job.out);
}

}  // namespace taktwerk::apps
