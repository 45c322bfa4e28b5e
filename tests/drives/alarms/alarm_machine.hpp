#pragma once
// One drive of config/machines/five-drives.yaml as a whole machine in virtual time, and what a person sees of its alarms: the log of
// `taktwerk run`, the list over LCM, the monitor.

#include <algorithm>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/machine/machine_log.hpp"
#include "apps/machine/monitor_screen.hpp"
#include "axes/axis/alarms.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "hmi_bridge/lcm/memory_bus.hpp"
#include "hmi_bridge/lcm/publisher.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "hmi_bridge/socket/json_state.hpp"
#include "taktwerk_lcm/alarm_list_v1_t.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::test {

using namespace std::chrono_literals;
using Json = nlohmann::json;

/// The axes of that drive (of two of a kind the first one) and the terminal with the emergency stop; no program, no group, no events, in manual mode.
inline runtime::MachineConfig machine_of(const std::string& drive) {
    config::LoadOptions options;
    options.simulate = true;
    options.resolve_programs = false;
    options.drive_dirs.emplace_back(TAKTWERK_SOURCE_DIR "/config/drives");
    auto loaded = config::load_machine(TAKTWERK_SOURCE_DIR "/config/machines/five-drives.yaml", options);
    if (const auto* errors = std::get_if<1>(&loaded)) {
        for (const auto& error : *errors) ADD_FAILURE() << error.text();
        return {};
    }
    auto m = std::move(std::get<0>(loaded).machine);
    m.name = "test";
    m.programs.clear();
    m.tasks.clear();
    m.simulation.events.clear();
    m.simulation.supervision = runtime::Supervision::strict;
    m.start_mode = runtime::Mode::manual;
    m.axis_groups.clear();
    std::erase_if(m.axes, [&](const auto& axis) { return axis.profile->name != drive || axis.slave == "belt_drive"; });
    const auto used = [&](const std::string& slave) {
        return slave == "io" || std::any_of(m.axes.begin(), m.axes.end(), [&](const auto& axis) { return axis.slave == slave; });
    };
    std::erase_if(m.bus.slaves, [&](const auto& slave) { return !used(slave.name); });
    for (std::size_t i = 0; i < m.bus.slaves.size(); ++i)
        if (m.bus.slaves[i].position) m.bus.slaves[i].position = static_cast<std::uint16_t>(i);
    if (m.axes[0].drive.empty()) {
        m.serial.clear();
        std::erase_if(m.io, [](const auto& point) { return point.direction == runtime::IoDirection::output; });
    }
    return m;
}

class AlarmMachine : public runtime::testing::TestMachine {
public:
    /// An alarm of the list over LCM.
    using Message = taktwerk_lcm::alarm_v1_t;

    explicit AlarmMachine(const std::string& drive) : TestMachine(machine_of(drive)), profile_(machine->config().axes[0].profile) {
        on_cycle = [this] {
            if (log_) log_->step(clock.now(), machine->latest());
            publisher_.step(machine->latest(), clock.now());
        };
        up_ = runner->bring_up().ok() && until([this] { return axis(0).online; }, 5s);
    }
    [[nodiscard]] bool is_up() const { return up_; }
    [[nodiscard]] const axes::DriveProfile& profile() const { return *profile_; }
    [[nodiscard]] std::uint16_t axis_count() const { return static_cast<std::uint16_t>(machine->layout().axes.size()); }

    /// What the log says meanwhile, a line each. What a failed expectation prints there would be lost.
    template <typename Action>
    std::vector<Json> log_of(Action action) {
        ::testing::internal::CaptureStdout();
        log_.emplace(*machine, clock.now(), true);
        action();
        log_.reset();
        std::vector<Json> lines;
        std::istringstream text(::testing::internal::GetCapturedStdout());
        for (std::string line; std::getline(text, line);) lines.push_back(Json::parse(line));
        return lines;
    }

    // --- what happens to the drive ------------------------------------------------------------------------------------------------
    /// The cause of this alarm begins; one of the whole drive concerns all of its axes.
    void provoke(const axes::DriveAlarmText& row) {
        if (auto* serial = serial_drive()) return serial->servo().provoke(row.code);
        const std::uint16_t concerned = row.whole_drive ? axis_count() : std::uint16_t{1};
        for (std::uint16_t i = 0; i < concerned; ++i) EXPECT_TRUE(simulated(i)->provoke(row.panel));
    }
    void release(const axes::DriveAlarmText& row) {
        if (auto* serial = serial_drive()) return serial->servo().release();
        for (std::uint16_t i = 0; i < axis_count(); ++i) simulated(i)->release(row.panel);
    }
    void switch_off_and_on() {
        if (auto* serial = serial_drive()) {
            serial->servo().power_off();
            EXPECT_TRUE(until([this] { return !axis(0).online; }, 5s));
            serial->servo().power_on(clock.now());
        } else {
            const auto& slave = machine->config().axes[0].slave;
            world.set_slave_power(slave, false);
            EXPECT_TRUE(until([this] { return !axis(0).online; }, 5s));
            world.set_slave_power(slave, true);
        }
    }

    // --- what a person sees -------------------------------------------------------------------------------------------------------
    /// The drive's own alarm that an axis shows.
    [[nodiscard]] const runtime::ActiveAlarm* shown(std::uint16_t axis) {
        const auto& s = state();
        for (std::size_t i = 0; i < s.alarm_count; ++i) {
            const auto& fact = s.alarms[i].fact;
            const bool of_drive = fact.id == id(axes::AxisAlarm::drive_fault) || fact.id == id(axes::AxisAlarm::drive_warning);
            if (of_drive && fact.source == AlarmSource::axis && fact.index == axis) return &s.alarms[i];
        }
        return nullptr;
    }
    [[nodiscard]] std::string said(std::uint16_t axis) {
        const auto* alarm = shown(axis);
        return alarm ? machine->describe(alarm->fact).english : std::string{};
    }
    /// Of an axis, in the newest list over LCM.
    [[nodiscard]] std::vector<Message> over_lcm(const std::string& axis) {
        std::vector<Message> out;
        std::int64_t newest = -1;
        for (const auto& message : bus_.published) {
            if (message.channel != "TAKTWERK_TEST_ALARM_LIST") continue;
            taktwerk_lcm::alarm_list_v1_t list;
            if (list.decode(message.bytes.data(), 0, static_cast<int>(message.bytes.size())) < 0) continue;
            if (list.revision != newest) out.clear();
            newest = list.revision;
            for (const auto& alarm : list.alarm)
                if (alarm.source_text == "axis " + axis) out.push_back(alarm);
        }
        return out;
    }
    void forget_messages() { bus_.published.clear(); }
    [[nodiscard]] std::vector<std::string> monitor() {
        const auto snapshot = nlohmann::ordered_json::parse(hmi::state_json(state(), link_));
        return apps::monitor_screen(snapshot, nlohmann::ordered_json{{"cycle_ns", 1000000}}, {500, 200, false});
    }

private:
    axes::sim::Cia402Axis* simulated(std::uint16_t axis) { return world.drive(machine->layout().axes[axis].name); }
    axes::sim::xp200::Drive* serial_drive() { return world.serial().drive(machine->layout().axes[0].name); }

    std::shared_ptr<const axes::DriveProfile> profile_;
    std::optional<apps::MachineLog> log_;
    hmi::RuntimeLink link_{*machine};
    hmi::MemoryBus bus_;
    hmi::Publisher publisher_{bus_, link_, 20.0, false, [] { return std::int64_t{1}; }};
    bool up_ = false;
};

}  // namespace taktwerk::test
