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
inline constexpr AlarmId cable_broken = 0x1013;
inline constexpr AlarmId slaves_missing = 0x1014;
inline constexpr AlarmId slave_dropped_out = 0x1015;
inline constexpr AlarmId branch_dropped_out = 0x1016;
inline constexpr AlarmId station_address_lost = 0x1017;
inline constexpr AlarmId other_device = 0x1018;
inline constexpr AlarmId slave_does_not_return = 0x1019;
inline constexpr AlarmId mailbox_silent = 0x101A;
inline constexpr AlarmId other_device_tolerated = 0x101B;
inline constexpr AlarmId starved_slave_left_op = 0x101C;
inline constexpr AlarmId starved_slave_dropped_out = 0x101D;
inline constexpr AlarmId foreign_command = 0x101E;
inline constexpr AlarmId foreign_command_tolerated = 0x101F;
inline constexpr AlarmId dc_out_of_sync = 0x1020;
inline constexpr AlarmId dc_not_locked = 0x1021;
inline constexpr AlarmId reference_clock_lost = 0x1022;
inline constexpr AlarmId foreign_master = 0x1030;
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
              "this computer is too late for the cycle, another master disturbs, a cable or connector is defect, or a slave lost power",
              "look for late_wakeups and foreign_master first; then check cables and the slaves' error counters", ResetRule::acknowledge,
              Reaction::stop_machine, "drives stop by their SM watchdog or SYNC0 supervision"},
    AlarmInfo{alarm::working_counter_wrong, "working_counter_wrong", "Process data of the slave was not exchanged for {a} cycles",
              "从站过程数据已 {a} 个周期未交换", "the slave, or one that shares its sync unit, does not take part",
              "look for another alarm of the slave; check its power and state", ResetRule::acknowledge, Reaction::stop_machine,
              "the drive stops by its SM watchdog"},
    AlarmInfo{alarm::slave_lost, "slave_lost", "The slave fell silent", "从站失去应答",
              "power lost, cable pulled, or its controller was reset",
              "check its power and cable; it is taken back to OP by itself when it returns", ResetRule::acknowledge, Reaction::stop_machine,
              "the drive stops by its SM watchdog"},
    AlarmInfo{alarm::slave_left_op, "slave_left_op", "The slave left OP", "从站退出 OP 状态",
              "the AL status code says why: 001Bh no frames within its watchdog time, 001Ah and 002Ch to 0034h synchronisation, others are "
              "its own",
              "read the text behind the code; the bus acknowledges it and returns the slave to OP", ResetRule::acknowledge,
              Reaction::stop_machine, "the drive reacts by its own fault reaction"},
    AlarmInfo{alarm::starved_slave_left_op, "starved_slave_left_op", "This computer sent nothing for {a} ms, and slaves left OP ({b})",
              "本控制器 {a} ms 未发送报文，{b} 个从站退出 OP 状态",
              "this computer was late, not the slaves: their watchdogs or their synchronisation did what they are there for",
              "see late_wakeups: a task that computes too long, another process, no real time; the slaves are returned to OP by themselves",
              ResetRule::acknowledge, Reaction::stop_machine, "the drives react by their own fault reactions"},
    AlarmInfo{alarm::starved_slave_dropped_out, "starved_slave_dropped_out",
              "This computer sent nothing for {a} ms, and slaves dropped out ({b}); the others run on",
              "本控制器 {a} ms 未发送报文，{b} 个从站已退出，其余从站继续运行",
              "this computer was late, not the slaves: their watchdogs or their synchronisation did what they are there for",
              "see late_wakeups: a task that computes too long, another process, no real time; the slaves are returned to OP by themselves",
              ResetRule::acknowledge, Reaction::warn, "the drives stop by their SM watchdogs"},
    AlarmInfo{alarm::foreign_command, "foreign_command", "Somebody else took slaves out of OP ({a}): they report no error of their own",
              "其他主站使 {a} 个从站退出 OP 状态：从站未报告自身错误",
              "another master or a configuration tool gave them another state (one that is in INIT may have restarted by itself)",
              "connect the bus to this controller only; the slaves are returned to OP by themselves", ResetRule::acknowledge,
              Reaction::stop_machine, "the drives react by their own fault reactions"},
    AlarmInfo{alarm::foreign_command_tolerated, "foreign_command_tolerated",
              "Somebody else took slaves out of OP ({a}), and they report no error of their own; the others run on",
              "其他主站使 {a} 个从站退出 OP 状态，从站未报告自身错误；其余从站继续运行",
              "another master or a configuration tool gave them another state (one that is in INIT may have restarted by itself)",
              "connect the bus to this controller only; the slaves are returned to OP by themselves", ResetRule::acknowledge,
              Reaction::warn, "the drives react by their own fault reactions"},
    AlarmInfo{alarm::cable_broken, "cable_broken", "{a} slaves behind one cable fell silent", "同一电缆后的 {a} 个从站失去应答",
              "the cable to this slave is pulled or broken, or its power went",
              "check cable and power at the place named; the slaves are taken back to OP by themselves when they return",
              ResetRule::acknowledge, Reaction::stop_machine, "the drives stop by their SM watchdog"},
    AlarmInfo{alarm::slaves_missing, "slaves_missing", "{a} of {b} slaves do not answer", "{b} 个从站中有 {a} 个无应答",
              "power lost or cable pulled; who it is will be known in a moment", "read the alarm that follows", ResetRule::self_clearing,
              Reaction::stop_machine, "the drives stop by their SM watchdog"},
    // Slaves with on_loss: stop_own_axes. Their axes stop by axis_feedback_lost.
    AlarmInfo{alarm::slave_dropped_out, "slave_dropped_out", "The slave dropped out; the others run on", "从站已退出，其余从站继续运行",
              "power lost, cable pulled, or an error of its own; its configuration says on_loss: stop_own_axes",
              "check its power, cable and AL status code; it is taken back to OP by itself", ResetRule::acknowledge, Reaction::warn,
              "the drive stops by its SM watchdog"},
    AlarmInfo{alarm::branch_dropped_out, "branch_dropped_out", "{a} slaves behind one cable dropped out; the others run on",
              "同一电缆后的 {a} 个从站已退出，其余从站继续运行",
              "the cable to this slave is pulled, or its power went; all of them have on_loss: stop_own_axes",
              "plug it in; they are taken back to OP by themselves", ResetRule::acknowledge, Reaction::warn,
              "the drives stop by their SM watchdog"},
    AlarmInfo{alarm::station_address_lost, "station_address_lost", "The slave exchanges process data, but lost its station address",
              "从站仍交换过程数据，但站地址已丢失",
              "something wrote its address: another master (then foreign_master is shown, too), or its controller was disturbed",
              "the address is given back by itself; when it comes again, look for another master on the cable", ResetRule::self_clearing,
              Reaction::warn, ""},
    AlarmInfo{alarm::other_device, "other_device", "Another device stands in the slave's place", "从站位置上是另一种设备",
              "the slave was replaced, or cables were swapped",
              "read the note in the bus log: it names expected and found; put the right device there or restart with another configuration",
              ResetRule::acknowledge, Reaction::stop_machine, "the slave is gone: its drive stopped by its SM watchdog"},
    AlarmInfo{alarm::slave_does_not_return, "slave_does_not_return", "The slave does not come back to OP: {a} attempts",
              "从站未能返回 OP：已尝试 {a} 次", "it refuses a state, its mailbox is dead, or its settings changed",
              "read the reason behind this text; power-cycle the slave, then restart the bus", ResetRule::self_clearing, Reaction::warn,
              ""},
    AlarmInfo{alarm::mailbox_silent, "mailbox_silent", "The slave does not answer in its mailbox", "从站邮箱无应答",
              "the slave's application hangs; process data still runs",
              "parameters cannot be read or written: power-cycle the slave when the machine stands", ResetRule::self_clearing,
              Reaction::warn, ""},
    AlarmInfo{alarm::other_device_tolerated, "other_device_tolerated", "Another device stands in the slave's place; the others run on",
              "从站位置上是另一种设备，其余从站继续运行",
              "the slave was replaced, or cables were swapped; its configuration says on_loss: stop_own_axes", "put the right device there",
              ResetRule::acknowledge, Reaction::warn, "the slave is gone: its drive stopped by its SM watchdog"},
    AlarmInfo{alarm::dc_out_of_sync, "dc_out_of_sync", "Distributed clocks differ by {a:ns}", "分布式时钟偏差 {a:ns}",
              "reference times are lost, or a slave's clock is defective", "check the reference slave and lost frames",
              ResetRule::self_clearing, Reaction::warn, "drives supervise SYNC0 themselves"},
    AlarmInfo{alarm::dc_not_locked, "dc_not_locked", "The cycle is not locked to the reference clock ({a:ns} off)",
              "控制周期未与参考时钟同步（偏差 {a:ns}）", "the reference clock does not answer or jumped, or the cycle runs unevenly",
              "check the reference slave, lost frames and the cycle's lateness", ResetRule::self_clearing, Reaction::warn,
              "outputs may miss SYNC0: drives supervise that themselves"},
    AlarmInfo{alarm::reference_clock_lost, "reference_clock_lost", "No usable time of the reference clock for {a} cycles",
              "已有 {a} 个周期未收到可用的参考时钟时间",
              "the reference clock stands still or jumps, or a slave with a clock does not take part",
              "power-cycle the first slave with distributed clocks; look for another alarm of a slave", ResetRule::self_clearing,
              Reaction::warn, "the clocks drift apart; drives supervise SYNC0 themselves"},
    AlarmInfo{alarm::foreign_master, "foreign_master", "Frames of another EtherCAT master are on the cable",
              "电缆上存在其他 EtherCAT 主站的报文",
              "a second controller or a configuration tool is connected to the bus, or the cable goes into an office network",
              "connect the bus to this controller only; its address stands behind this text", ResetRule::self_clearing, Reaction::warn, ""},
    AlarmInfo{alarm::slave_emergency, "slave_emergency", "The slave sent emergency {a:x4}h (error register {b:x2}h)",
              "从站发出紧急报文 {a:x4}h（错误寄存器 {b:x2}h）", "the slave found an error of its own; the code is that of its object 603Fh",
              "look the code up in the device's manual; goes when the slave says that the error is gone, or starts anew",
              ResetRule::self_clearing, Reaction::warn, "the drive reacts by its own fault reaction"},
};

}  // namespace taktwerk::ecat
