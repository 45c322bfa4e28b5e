#pragma once
// An alarm in words, put together from its row in the table of its floor and from what the machine knows beyond it. Outside the cycle.

#include <string>
#include <string_view>

#include "runtime/machine/hot_connect.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/machine_drives.hpp"
#include "runtime/machine/modbus_devices.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/machine/supervisor.hpp"

namespace taktwerk::runtime {

class AlarmWords {
public:
    AlarmWords(const MachineBody& body, const MachineDrives& drives, const HotConnect& groups, const ModbusDevices& modbus,
               const ProgramRunner& programs, const Supervisor& supervisor, const MachineLayout& layout)
        : body_(body), drives_(drives), groups_(groups), modbus_(modbus), programs_(programs), supervisor_(supervisor), layout_(layout) {}

    [[nodiscard]] AlarmText describe(const AlarmFact& fact) const;

private:
    [[nodiscard]] std::string source(const AlarmFact& fact) const;
    /// A row of the tables, its two numbers filled in.
    void tell_row(AlarmText& out, const AlarmFact& fact, const AlarmInfo& info) const;
    /// What programs have declared themselves. False: the alarm is none of theirs.
    bool tell_declared(AlarmText& out, const AlarmFact& fact) const;
    /// What goes beyond the row, by whose alarm it is.
    void tell_more_of_bus(AlarmText& out, const AlarmFact& fact) const;
    void tell_more_of_input(AlarmText& out, const AlarmFact& fact) const;
    void tell_more_of_machine(AlarmText& out, const AlarmFact& fact) const;
    void tell_more_of_modbus(AlarmText& out, const AlarmFact& fact) const;
    void tell_more_of_programs(AlarmText& out, const AlarmFact& fact) const;
    void tell_more_of_axis(AlarmText& out, const AlarmFact& fact) const;
    void tell_chosen_reaction(AlarmText& out, const AlarmFact& fact) const;
    void tell_more_of_drive(AlarmText& out, const AlarmFact& fact) const;

    const MachineBody& body_;
    const MachineDrives& drives_;
    const HotConnect& groups_;
    const ModbusDevices& modbus_;
    const ProgramRunner& programs_;
    const Supervisor& supervisor_;
    const MachineLayout& layout_;
};

}  // namespace taktwerk::runtime
