#pragma once
// The alarms of the bus, 1xxxh: what each means, why, what to do, and how the machine reacts. The only place that decides.

#include <array>

#include "core/alarm.hpp"

namespace taktwerk::ecat {

namespace alarm {
inline constexpr AlarmId bus_not_operational = 0x1001;
inline constexpr AlarmId bringup_failed = 0x1002;
inline constexpr AlarmId link_down = 0x1003;
inline constexpr AlarmId frames_lost = 0x1004;
inline constexpr AlarmId working_counter_wrong = 0x1010;
inline constexpr AlarmId slave_lost = 0x1011;
inline constexpr AlarmId slave_left_op = 0x1012;
inline constexpr AlarmId dc_out_of_sync = 0x1020;
inline constexpr AlarmId dc_not_locked = 0x1021;
inline constexpr AlarmId slave_emergency = 0x1040;
}  // namespace alarm

inline constexpr std::array bus_alarms{
    AlarmInfo{alarm::bus_not_operational, "bus_not_operational", "The EtherCAT bus is not operational", "EtherCAT 总线未运行",
              "the bring-up is still running, or the bus was stopped", "wait for the bring-up; if it does not end, read its progress line",
              ResetRule::self_clearing, Reaction::none, ""},
    AlarmInfo{alarm::bringup_failed, "bringup_failed", "The EtherCAT bus could not be started", "EtherCAT 总线启动失败",
              "a slave is missing, is another device, or refused a state",
              "read the bus failure text: it names slave, reason and remedy; then restart", ResetRule::restart, Reaction::stop_machine,
              "drives stay without power: they never reached OP"},
    AlarmInfo{alarm::link_down, "link_down", "No link on the EtherCAT port", "EtherCAT 网口无连接",
              "cable pulled, first slave without power, or network port disabled",
              "check the cable between the controller and the first slave", ResetRule::acknowledge, Reaction::stop_machine,
              "drives stop by their SM watchdog"},
    AlarmInfo{alarm::frames_lost, "frames_lost", "{a} bus cycles in a row without an answer", "连续 {a} 个总线周期无应答",
              "cable or connector defect, a slave that lost power, or a controller that is too slow for the cycle",
              "check cables and the slaves' error counters; check the cycle's lateness", ResetRule::acknowledge, Reaction::stop_machine,
              "drives stop by their SM watchdog or SYNC0 supervision"},
    AlarmInfo{alarm::working_counter_wrong, "working_counter_wrong", "Process data of the slave was not exchanged for {a} cycles",
              "从站过程数据已 {a} 个周期未交换", "the slave, or one that shares its sync unit, does not take part",
              "look for another alarm of the slave; check its power and state", ResetRule::acknowledge, Reaction::stop_machine,
              "the drive stops by its SM watchdog"},
    AlarmInfo{alarm::slave_lost, "slave_lost", "The slave does not answer", "从站无应答",
              "power lost, cable pulled, or its controller was reset",
              "check its power and cable; it is taken back to OP by itself when it returns", ResetRule::acknowledge, Reaction::stop_machine,
              "the drive stops by its SM watchdog"},
    AlarmInfo{alarm::slave_left_op, "slave_left_op", "The slave left OP (AL status {a}, code {b})",
              "从站退出 OP 状态（AL 状态 {a}，代码 {b}）", "the slave found an error of its own: watchdog, synchronisation, configuration",
              "read the AL status code; the bus acknowledges it and returns the slave to OP", ResetRule::acknowledge,
              Reaction::stop_machine, "the drive reacts by its own fault reaction"},
    AlarmInfo{alarm::dc_out_of_sync, "dc_out_of_sync", "Distributed clocks differ by {a} ns", "分布式时钟偏差 {a} ns",
              "reference times are lost, or a slave's clock is defective", "check the reference slave and lost frames",
              ResetRule::self_clearing, Reaction::warn, "drives supervise SYNC0 themselves"},
    AlarmInfo{alarm::dc_not_locked, "dc_not_locked", "The cycle is not locked to the reference clock ({a} ns off)",
              "控制周期未与参考时钟同步（偏差 {a} ns）", "the reference clock does not answer or jumped, or the cycle runs unevenly",
              "check the reference slave, lost frames and the cycle's lateness", ResetRule::self_clearing, Reaction::warn,
              "outputs may miss SYNC0: drives supervise that themselves"},
    AlarmInfo{alarm::slave_emergency, "slave_emergency", "The slave sent emergency 0x{a:x} (error register 0x{b:x})",
              "从站发出紧急报文 0x{a:x}（错误寄存器 0x{b:x}）", "the slave found an error of its own; the code is that of its object 603Fh",
              "look the code up in the device's manual; goes when the slave says that the error is gone, or starts anew",
              ResetRule::self_clearing, Reaction::warn, "the drive reacts by its own fault reaction"},
};

}  // namespace taktwerk::ecat
