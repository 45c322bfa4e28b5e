#pragma once
// The alarms of the bus, 1xxxh: what each means, why, what to do, and how the machine reacts. The only place that decides.

#include <array>
#include <optional>

#include "core/alarm.hpp"

namespace taktwerk::ecat {

enum class BusAlarm : AlarmId {
    bus_not_operational = 0x1001,
    bringup_failed = 0x1002,
    link_down = 0x1003,
    frames_lost = 0x1004,
    ring_broken = 0x1005,
    working_counter_wrong = 0x1010,
    slave_lost = 0x1011,
    slave_left_op = 0x1012,
    cable_broken = 0x1013,
    slaves_missing = 0x1014,
    slave_dropped_out = 0x1015,
    branch_dropped_out = 0x1016,
    station_address_lost = 0x1017,
    other_device = 0x1018,
    slave_does_not_return = 0x1019,
    mailbox_silent = 0x101A,
    other_device_tolerated = 0x101B,
    starved_slave_left_op = 0x101C,
    starved_slave_dropped_out = 0x101D,
    foreign_command = 0x101E,
    foreign_command_tolerated = 0x101F,
    dc_out_of_sync = 0x1020,
    dc_not_locked = 0x1021,
    reference_clock_lost = 0x1022,
    cut_off_from_reference = 0x1023,
    cable_errors = 0x1024,
    cable_loses_link = 0x1025,
    group_does_not_join = 0x1026,
    stranger_plugged_in = 0x1027,
    sync_unit_not_exchanged = 0x1028,
    sync_unit_dropped_out = 0x1029,
    foreign_master = 0x1030,
    newcomer_takes_part = 0x1031,
    slave_emergency = 0x1040,
};

[[nodiscard]] constexpr AlarmId id(BusAlarm alarm) noexcept { return static_cast<AlarmId>(alarm); }

inline constexpr std::array bus_alarms{
    AlarmInfo{id(BusAlarm::bus_not_operational), "bus_not_operational", "The EtherCAT bus is not operational", "EtherCAT 总线未运行",
              "the bring-up is still running, or the bus was stopped", "wait for the bring-up; if it does not end, read its progress line",
              ResetRule::self_clearing, Reaction::none, ""},
    AlarmInfo{id(BusAlarm::bringup_failed), "bringup_failed", "The EtherCAT bus could not be started", "EtherCAT 总线启动失败",
              "a slave is missing, is another device, or refused a state",
              "read the bus failure text: it names slave, reason and remedy; then restart", ResetRule::restart, Reaction::stop_machine,
              "drives stay without power: they never reached OP"},
    AlarmInfo{id(BusAlarm::link_down), "link_down", "No link on the EtherCAT port", "EtherCAT 网口无连接",
              "cable pulled, first slave without power, or network port disabled",
              "read what stands with the port, where it is the reason; else check the cable between the controller and the first slave",
              ResetRule::acknowledge, Reaction::stop_machine, "drives stop by their SM watchdog"},
    AlarmInfo{id(BusAlarm::frames_lost), "frames_lost", "{a} bus cycles in a row without an answer", "连续 {a} 个总线周期无应答",
              "a cable or connector is defect, a slave lost power, or answers come back after their cycle",
              "check cables and the slaves' error counters; where another alarm of the machine or the bus stands beside it, that one first",
              ResetRule::acknowledge, Reaction::stop_machine, "drives stop by their SM watchdog or SYNC0 supervision"},
    AlarmInfo{id(BusAlarm::ring_broken), "ring_broken", "The ring is broken: {a} slaves are reached from one end, {b} from the other",
              "环网断开：一端可达 {a} 个从站，另一端可达 {b} 个从站",
              "a cable is pulled or broken, or a slave lost power; all slaves that have power run on",
              "mend the cable at the place named before a second one breaks: that one would take slaves away", ResetRule::acknowledge,
              Reaction::warn, ""},
    AlarmInfo{id(BusAlarm::working_counter_wrong), "working_counter_wrong", "Process data of the slave was not exchanged for {a} cycles",
              "从站过程数据已 {a} 个周期未交换",
              "the slave answers and does not take part: its sync managers or FMMUs are not as they were written, or its application "
              "holds them",
              "read what stands behind this text: it is set up again by itself; when it comes again power-cycle the slave",
              ResetRule::acknowledge, Reaction::stop_machine, "the drive stops by its SM watchdog"},
    AlarmInfo{id(BusAlarm::sync_unit_not_exchanged), "sync_unit_not_exchanged",
              "Process data of {a} slaves that share a sync unit was not exchanged for {b} cycles",
              "共用同步单元的 {a} 个从站过程数据已 {b} 个周期未交换",
              "one of them does not take part, and their working counter does not say which: each is being asked",
              "read the alarm that follows; where none does, take `sync_unit` away from the slaves that are named: then each has a working "
              "counter of its own",
              ResetRule::self_clearing, Reaction::stop_machine, "the drives stop by their SM watchdogs"},
    AlarmInfo{id(BusAlarm::sync_unit_dropped_out), "sync_unit_dropped_out",
              "Process data of {a} slaves that share a sync unit was not exchanged for {b} cycles; the others run on",
              "共用同步单元的 {a} 个从站过程数据已 {b} 个周期未交换，其余从站继续运行",
              "one of them does not take part, and their working counter does not say which: each is being asked",
              "read the alarm that follows; where none does, take `sync_unit` away from the slaves that are named: then each has a working "
              "counter of its own",
              ResetRule::self_clearing, Reaction::warn, "the drives stop by their SM watchdogs"},
    AlarmInfo{id(BusAlarm::slave_lost), "slave_lost", "The slave fell silent", "从站失去应答",
              "power lost, cable pulled, or its controller was reset",
              "check its power and cable; it is taken back to OP by itself when it returns", ResetRule::acknowledge, Reaction::stop_machine,
              "the drive stops by its SM watchdog"},
    AlarmInfo{id(BusAlarm::slave_left_op), "slave_left_op", "The slave left OP", "从站退出 OP 状态",
              "the AL status code says why: 001Bh no frames within its watchdog time, 001Ah and 002Ch to 0034h synchronisation, others are "
              "its own",
              "read the text behind the code; the bus acknowledges it and returns the slave to OP", ResetRule::acknowledge,
              Reaction::stop_machine, "the drive reacts by its own fault reaction"},
    AlarmInfo{id(BusAlarm::starved_slave_left_op), "starved_slave_left_op",
              "This computer sent nothing for {a} ms, and slaves left OP ({b})", "本控制器 {a} ms 未发送报文，{b} 个从站退出 OP 状态",
              "this computer was late, not the slaves: their watchdogs or their synchronisation did what they are there for",
              "see late_wakeups: a task that computes too long, another process, no real time; the slaves are returned to OP by themselves",
              ResetRule::acknowledge, Reaction::stop_machine, "the drives react by their own fault reactions"},
    AlarmInfo{id(BusAlarm::starved_slave_dropped_out), "starved_slave_dropped_out",
              "This computer sent nothing for {a} ms, and slaves dropped out ({b}); the others run on",
              "本控制器 {a} ms 未发送报文，{b} 个从站已退出，其余从站继续运行",
              "this computer was late, not the slaves: their watchdogs or their synchronisation did what they are there for",
              "see late_wakeups: a task that computes too long, another process, no real time; the slaves are returned to OP by themselves",
              ResetRule::acknowledge, Reaction::warn, "the drives stop by their SM watchdogs"},
    AlarmInfo{id(BusAlarm::foreign_command), "foreign_command",
              "Somebody else took slaves out of OP ({a}): they report no error of their own",
              "其他主站使 {a} 个从站退出 OP 状态：从站未报告自身错误",
              "another master or a configuration tool gave them another state (one that is in INIT may have restarted by itself)",
              "connect the bus to this controller only; the slaves are returned to OP by themselves", ResetRule::acknowledge,
              Reaction::stop_machine, "the drives react by their own fault reactions"},
    AlarmInfo{id(BusAlarm::foreign_command_tolerated), "foreign_command_tolerated",
              "Somebody else took slaves out of OP ({a}), and they report no error of their own; the others run on",
              "其他主站使 {a} 个从站退出 OP 状态，从站未报告自身错误；其余从站继续运行",
              "another master or a configuration tool gave them another state (one that is in INIT may have restarted by itself)",
              "connect the bus to this controller only; the slaves are returned to OP by themselves", ResetRule::acknowledge,
              Reaction::warn, "the drives react by their own fault reactions"},
    AlarmInfo{id(BusAlarm::cable_broken), "cable_broken", "{a} slaves behind one cable fell silent", "同一电缆后的 {a} 个从站失去应答",
              "the cable to this slave is pulled or broken, or its power went",
              "check cable and power at the place named; the slaves are taken back to OP by themselves when they return",
              ResetRule::acknowledge, Reaction::stop_machine, "the drives stop by their SM watchdog"},
    AlarmInfo{id(BusAlarm::slaves_missing), "slaves_missing", "{a} of {b} slaves do not answer", "{b} 个从站中有 {a} 个无应答",
              "power lost or cable pulled; who it is will be known in a moment", "read the alarm that follows", ResetRule::self_clearing,
              Reaction::stop_machine, "the drives stop by their SM watchdog"},
    // Slaves with on_loss: stop_own_axes. Their axes stop by axis_feedback_lost.
    AlarmInfo{id(BusAlarm::slave_dropped_out), "slave_dropped_out", "The slave dropped out; the others run on",
              "从站已退出，其余从站继续运行",
              "power lost, cable pulled, or an error of its own; its configuration says on_loss: stop_own_axes",
              "check its power, cable and AL status code; it is taken back to OP by itself", ResetRule::acknowledge, Reaction::warn,
              "the drive stops by its SM watchdog"},
    AlarmInfo{id(BusAlarm::branch_dropped_out), "branch_dropped_out", "{a} slaves behind one cable dropped out; the others run on",
              "同一电缆后的 {a} 个从站已退出，其余从站继续运行",
              "the cable to this slave is pulled, or its power went; all of them have on_loss: stop_own_axes",
              "plug it in; they are taken back to OP by themselves", ResetRule::acknowledge, Reaction::warn,
              "the drives stop by their SM watchdog"},
    AlarmInfo{id(BusAlarm::station_address_lost), "station_address_lost", "The slave exchanges process data, but lost its station address",
              "从站仍交换过程数据，但站地址已丢失",
              "something wrote its address: another master (then foreign_master is shown, too), or its controller was disturbed",
              "the address is given back by itself; when it comes again, look for another master on the cable", ResetRule::self_clearing,
              Reaction::warn, ""},
    AlarmInfo{id(BusAlarm::other_device), "other_device", "Another device stands in the slave's place", "从站位置上是另一种设备",
              "the slave was replaced, or cables were swapped",
              "read the note in the bus log: it names expected and found; put the right device there or restart with another configuration",
              ResetRule::acknowledge, Reaction::stop_machine, "the slave is gone: its drive stopped by its SM watchdog"},
    AlarmInfo{id(BusAlarm::slave_does_not_return), "slave_does_not_return", "The slave does not come back to OP: {a} attempts",
              "从站未能返回 OP：已尝试 {a} 次", "it refuses a state, its mailbox is dead, or its settings changed",
              "read the reason behind this text; power-cycle the slave, then restart the bus", ResetRule::self_clearing, Reaction::warn,
              ""},
    AlarmInfo{id(BusAlarm::mailbox_silent), "mailbox_silent", "The slave does not answer in its mailbox", "从站邮箱无应答",
              "the slave's application hangs; process data still runs",
              "parameters cannot be read or written: power-cycle the slave when the machine stands", ResetRule::self_clearing,
              Reaction::warn, ""},
    AlarmInfo{id(BusAlarm::other_device_tolerated), "other_device_tolerated",
              "Another device stands in the slave's place; the others run on", "从站位置上是另一种设备，其余从站继续运行",
              "the slave was replaced, or cables were swapped; its configuration says on_loss: stop_own_axes", "put the right device there",
              ResetRule::acknowledge, Reaction::warn, "the slave is gone: its drive stopped by its SM watchdog"},
    AlarmInfo{id(BusAlarm::dc_out_of_sync), "dc_out_of_sync", "Distributed clocks differ by {a:ns}", "分布式时钟偏差 {a:ns}",
              "the clock of the slave that is named is defective or jumped, or reference times are lost",
              "power-cycle the slave that is named; where it comes again and no frames are lost, replace it", ResetRule::self_clearing,
              Reaction::warn, "drives supervise SYNC0 themselves"},
    AlarmInfo{id(BusAlarm::dc_not_locked), "dc_not_locked", "The cycle is not locked to the reference clock ({a:ns} off)",
              "控制周期未与参考时钟同步（偏差 {a:ns}）", "the reference clock does not answer or jumped, or the cycle runs unevenly",
              "check the reference slave, lost frames and the cycle's lateness", ResetRule::self_clearing, Reaction::warn,
              "outputs may miss SYNC0: drives supervise that themselves"},
    AlarmInfo{id(BusAlarm::reference_clock_lost), "reference_clock_lost", "No usable time of the reference clock for {a} cycles",
              "已有 {a} 个周期未收到可用的参考时钟时间",
              "the reference clock stands still or jumps, or a slave with a clock does not take part",
              "power-cycle the first slave with distributed clocks; look for another alarm of a slave", ResetRule::self_clearing,
              Reaction::warn, "the clocks drift apart; drives supervise SYNC0 themselves"},
    AlarmInfo{id(BusAlarm::cut_off_from_reference), "cut_off_from_reference", "The broken ring cuts the slave off from the reference clock",
              "环网断开，从站与参考时钟失去同步",
              "the ring is broken between the reference clock and this slave, and behind_break: ramp_down is configured",
              "mend the cable that ring_broken names; the slave is synchronised again by itself, its axes need a reset",
              ResetRule::acknowledge, Reaction::stop_axis, "the drive's clock runs by itself; it supervises SYNC0 itself"},
    AlarmInfo{id(BusAlarm::cable_errors), "cable_errors", "{a} frames were damaged on the cable at port {b} of the slave within a minute",
              "从站端口 {b} 的电缆一分钟内损坏了 {a} 个报文",
              "the cable at this port or its plugs are damaged, a shield is not connected, or a motor cable lies beside it",
              "replace the cable that is named, and look at its shield and its way; it will take slaves away some day",
              ResetRule::self_clearing, Reaction::warn, ""},
    AlarmInfo{id(BusAlarm::cable_loses_link), "cable_loses_link",
              "The cable at port {b} of the slave lost its link {a} times within a minute", "从站端口 {b} 的电缆一分钟内断开 {a} 次",
              "a plug that is not locked, a cable that breaks where it bends, or the device at its other end loses power for a moment",
              "look at the plugs and the cable that is named; it will take slaves away some day", ResetRule::self_clearing, Reaction::warn,
              ""},
    AlarmInfo{id(BusAlarm::group_does_not_join), "group_does_not_join", "A group was plugged in and does not join",
              "热插拔组已插入但无法加入", "it is not complete, not the one that is configured, plugged in twice, or refuses a state",
              "read what stands behind this text: it names the slave and the reason; it is tried again by itself", ResetRule::self_clearing,
              Reaction::warn, "its axes stay without power"},
    AlarmInfo{id(BusAlarm::stranger_plugged_in), "stranger_plugged_in", "A slave was plugged in that belongs to no group",
              "插入了不属于任何热插拔组的从站", "another tool than those configured, or one whose alias or device id is not set",
              "read what stands behind this text: add it to the machine file, set its number, or unplug it; it is left alone",
              ResetRule::self_clearing, Reaction::warn, ""},
    AlarmInfo{id(BusAlarm::foreign_master), "foreign_master", "Frames of another EtherCAT master are on the cable",
              "电缆上存在其他 EtherCAT 主站的报文",
              "a second controller or a configuration tool is connected to the bus, or the cable goes into an office network",
              "connect the bus to this controller only; its address stands behind this text", ResetRule::self_clearing, Reaction::warn, ""},
    AlarmInfo{id(BusAlarm::newcomer_takes_part), "newcomer_takes_part",
              "A slave that was plugged in takes part in the process data of others", "刚插入的从站参与了其他从站的过程数据交换",
              "it had power, and is still set up as another controller left it",
              "it is reset by itself; switch a tool off before it is plugged in, or let the coupling switch its power",
              ResetRule::acknowledge, Reaction::stop_machine, ""},
    AlarmInfo{id(BusAlarm::slave_emergency), "slave_emergency", "The slave sent emergency {a:x4}h (error register {b:x2}h)",
              "从站发出紧急报文 {a:x4}h（错误寄存器 {b:x2}h）", "the slave found an error of its own; the code is that of its object 603Fh",
              "look the code up in the device's manual; goes when the slave says that the error is gone, or starts anew",
              ResetRule::self_clearing, Reaction::warn, "the drive reacts by its own fault reaction"},
};

/// What was said of the same slave, or of any where the bus speaks, before it was known better: as long as it has no reason of its own (`a` is 0)
/// its place is taken, so that one trouble stays one alarm.
[[nodiscard]] constexpr std::optional<BusAlarm> said_before(AlarmId known_now) noexcept {
    switch (BusAlarm{known_now}) {
        case BusAlarm::other_device: return BusAlarm::slave_lost;
        case BusAlarm::other_device_tolerated: return BusAlarm::slave_dropped_out;
        case BusAlarm::slave_lost:
        case BusAlarm::foreign_command:
        case BusAlarm::starved_slave_left_op: return BusAlarm::slave_left_op;
        default: return std::nullopt;
    }
}
/// It may be over because it is known better: then another alarm of the bus has taken its place, and who stopped by it stopped by that.
[[nodiscard]] constexpr bool is_followed(AlarmId alarm) noexcept {
    switch (BusAlarm{alarm}) {
        case BusAlarm::slaves_missing:
        case BusAlarm::sync_unit_not_exchanged:
        case BusAlarm::slave_lost:
        case BusAlarm::slave_left_op: return true;
        default: return false;
    }
}

}  // namespace taktwerk::ecat
