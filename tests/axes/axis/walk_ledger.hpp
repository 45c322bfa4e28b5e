#pragma once
// What has become of each command that was accepted: none is forgotten, none runs on when its end could have come.

#include <map>

#include "axes/axis/command_kinds.hpp"
#include "axes/axis/homing_step_check.hpp"
#include "axes/axis/parameters.hpp"
#include "tests/axes/axis/walk_commands.hpp"

namespace taktwerk::axes::test {

/// How often what a walk must have seen did happen.
using WalkCounts = std::map<std::string, long, std::less<>>;

class WalkLedger {
public:
    struct Entry {
        CommandId id = 0;
        AxisCommand command;
        long since = 0;  // cycle
        bool started = false;
    };

    enum class Patience { left, over };

    explicit WalkLedger(std::size_t axes) : open_(axes), full_(axes) {}

    void accepted(std::size_t axis, CommandId id, const AxisCommand& command, long cycle) {
        open_[axis].push_back({id, command, cycle, false});
    }
    void updated(std::size_t axis, CommandId id, const AxisCommand& command) {
        for (auto& entry : open_[axis])
            if (entry.id == id) entry.command = command;
    }

    /// Once a cycle and axis; text when something went wrong.
    [[nodiscard]] std::string follow(std::size_t axis, const AxisView& view, const MotionTables& tables, WalkCounts& counts) {
        auto& open = open_[axis];
        std::string wrong;
        for (auto it = open.begin(); it != open.end();) {
            const auto status = view.status(it->id);
            if (status == CommandStatus::unknown)
                wrong += fmt::format("command {} ({}) is forgotten\n", it->id, walk_name(it->command.kind));
            if (status == CommandStatus::active || status == CommandStatus::in_target) it->started = true;
            const bool over = status != CommandStatus::queued && status != CommandStatus::active && status != CommandStatus::in_target;
            if (over && status == CommandStatus::done) ++counts[fmt::format("done {}", walk_name(it->command.kind))];
            it = over ? open.erase(it) : it + 1;
        }
        // What waits behind a command that hands over gets its turn; behind one that never ends nothing may wait.
        const auto* active = find(axis, view.active);
        const bool ready = view.queued_count > 0 && active && view.active_in_target && hands_over_in_target(active->command.kind);
        full_[axis] = ready ? full_[axis] + 1 : 0;
        if (full_[axis] == 20) wrong += fmt::format("command {} waits behind {} whose Inxxx holds\n", view.queued[0], view.active);
        if (view.queued_count > 0 && active && active->command.kind == CommandKind::cam_in) {
            const auto* cam = std::get_if<CamDetails>(&active->command.details);
            const auto* table = cam ? tables.prepared(cam->table) : nullptr;
            const auto* first = find(axis, view.queued[0]);  // settings pass
            const bool setting = first && first->command.kind == CommandKind::setting;
            if (table && table->periodic() && !setting) wrong += fmt::format("command {} waits behind a cam without end\n", view.queued[0]);
        }
        return wrong;
    }

    /// Those that should be over by now, with nothing asked of the axis any more and everything in order.
    [[nodiscard]] std::string unfinished(std::size_t axis, const AxisView& view, Patience patience) const {
        std::string out;
        for (const auto& entry : open_[axis])
            if (!may_last(view, entry, patience))
                out += fmt::format("command {} ({}) of cycle {} has status {} in {}\n", entry.id, walk_name(entry.command.kind),
                                   entry.since, static_cast<int>(view.status(entry.id)), name(view.state));
        return out;
    }
    /// After everything was stopped nothing may last but what waits for a signal.
    [[nodiscard]] std::string left_over(std::size_t axis) const {
        std::string out;
        for (const auto& entry : open_[axis])
            out += fmt::format("command {} ({}) of cycle {} outlives the stop\n", entry.id, walk_name(entry.command.kind), entry.since);
        return out;
    }

private:
    [[nodiscard]] const Entry* find(std::size_t axis, CommandId id) const {
        for (const auto& entry : open_[axis])
            if (entry.id == id) return &entry;
        return nullptr;
    }
    [[nodiscard]] bool may_last(const AxisView& view, const Entry& entry, Patience patience) const {
        using enum CommandKind;
        const auto kind = entry.command.kind;
        const auto* step = std::get_if<HomingStepDetails>(&entry.command.details);
        if (kind == touch_probe || (step && passive(step->step))) return true;  // wait for a signal
        // Behind what never shows its Inxxx (a slave out of reach, a torque that is not had, a cam whose master stands) others wait.
        if (view.status(entry.id) == CommandStatus::queued)
            return view.active != 0 && (!view.active_in_target || view.active_kind == cam_in);
        // Other coordinates make any way of an absolute target: it is on it.
        const bool on_long_way = patience == Patience::over && view.set_velocity != 0;
        if (kind == move_absolute) return on_long_way;
        // Only where the base takes nearly the whole velocity there is no room; at the end of such a way it has just become less.
        if (kind == move_superimposed)
            return std::abs(view.set_velocity) >
                       0.9 * view.parameters[place_of(view.set_velocity < 0 ? velocity_negative : velocity_positive)] ||
                   (on_long_way && view.active_kind == move_absolute);
        switch (kind) {
            case move_velocity:
            case move_continuous_absolute:
            case move_continuous_relative:
            case gear_in:
            case gear_in_pos:
            case cam_in:
            case combine:
            case velocity_profile:
            case acceleration_profile:
            case torque:
            case external:
            case drive_move_velocity:
            case drive_torque: return true;
            default: return false;
        }
    }

    std::vector<std::vector<Entry>> open_;
    std::vector<int> full_;
};

}  // namespace taktwerk::axes::test
