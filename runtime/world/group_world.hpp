#pragma once
// How groups of hot connect come and go in a simulated machine: by hand, or where an output of the machine opens their coupling. With the coupling
// goes the supply.

#include <string>
#include <string_view>
#include <vector>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

class World;

class GroupWorld {
public:
    explicit GroupWorld(World& world) : world_(world) {}

    /// Once the slaves are there: those groups that are away at the start are taken away.
    void build(const MachineConfig& config);
    /// What the outputs say. Each cycle, before the machine's.
    void step();
    /// By hand. An unknown name: nothing happens.
    void connect(std::string_view group, bool plugged);
    [[nodiscard]] bool connected(std::string_view group) const noexcept;

private:
    struct Group {
        GroupSimulation simulation;
        std::vector<std::string> slaves;  // its head first
        double counts_per_unit = 1;       // of the axis that carries the coupling
        bool connected = true, output = false;
    };
    void plug(Group& group, bool plugged);
    [[nodiscard]] bool reached(const Group& group) const;

    World& world_;
    std::vector<Group> groups_;
};

}  // namespace taktwerk::runtime
