#pragma once
// config/machines/five-drives.yaml in virtual time, without its program and its events: nobody moves anything but the test.

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "apps/machine/load.hpp"
#include "core/clock.hpp"
#include "runtime/run/virtual_runner.hpp"
#include "tests/machines/replay_check.hpp"

namespace taktwerk::apps {

struct SimulatedFiveDrives {
    /// `change`: what is different this time. In manual mode.
    void build(const std::function<void(runtime::MachineConfig&)>& change = {}) {
        auto result = read_machine_without_programs(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/five-drives.yaml", true);
        ASSERT_TRUE(std::holds_alternative<LoadedFile>(result));
        auto config = std::move(std::get<LoadedFile>(result).machine);
        config.programs.clear();
        config.tasks.clear();
        config.simulation.events.clear();
        config.start_mode = runtime::Mode::manual;
        if (change) change(config);
        world = std::make_unique<runtime::World>(config, clock.now());
        auto built = runtime::Machine::build(std::move(config), world->transport(), world->serial().lines());
        ASSERT_TRUE(std::holds_alternative<std::unique_ptr<runtime::Machine>>(built));
        machine = std::move(std::get<0>(built));
        runner.emplace(*machine, *world, clock);
        replayed.watch(*machine, &*runner, clock.now());
    }
    void bring_up() {
        const auto up = runner->bring_up();
        ASSERT_TRUE(up) << up.error().text();
        runner->run_for(std::chrono::seconds{1});  // the XP200 has been read
    }
    void command(runtime::OperatorCommand command) {
        ASSERT_TRUE(machine->submit(command));
        runner->run_for(std::chrono::milliseconds{10});
    }

    VirtualClock clock{Instant{}};
    std::unique_ptr<runtime::World> world;
    runtime::testing::ReplayCheck replayed;
    std::unique_ptr<runtime::Machine> machine;
    std::optional<runtime::VirtualRunner> runner;
};

}  // namespace taktwerk::apps
