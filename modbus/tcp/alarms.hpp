#pragma once
// What is said of a Modbus TCP device whose channels are too old. Which device and which request: runtime/machine/alarm_words.cpp.

#include <array>

#include "core/alarm.hpp"
#include "core/alarm_table.hpp"

namespace taktwerk::modbus::tcp {

enum class DeviceAlarm : AlarmId {
    refused = 0x2001,
    unreachable = 0x2002,
    silent = 0x2003,
    closed = 0x2004,
    exception = 0x2005,
    wrong_answer = 0x2006,
};

[[nodiscard]] constexpr AlarmId id(DeviceAlarm alarm) noexcept { return static_cast<AlarmId>(alarm); }

inline constexpr std::array<AlarmInfo, 6> device_alarms{{
    {id(DeviceAlarm::refused), "modbus_refused",
     "The Modbus device refuses the connection: its inputs keep their last values and are not good",
     "Modbus 设备拒绝连接:其输入保持最后的值且无效",
     "There is a computer at this address, but nobody listens at the port: the device starts up, its Modbus server is switched off, or "
     "`host` or `port` is another's",
     "Switch Modbus TCP on in the device's settings; compare `host` and `port` with them; some devices allow one client only",
     ResetRule::self_clearing, Reaction::warn, "A device with a watchdog of its own sets its outputs as it was told to"},
    {id(DeviceAlarm::unreachable), "modbus_unreachable",
     "No way leads to the Modbus device: its inputs keep their last values and are not good",
     "无法到达 Modbus 设备:其输入保持最后的值且无效",
     "The network port of this computer is down or in another subnet, a cable is off, or the device has no supply",
     "Look at supply, cable and switch; `ip addr` and `ip route get` show which port leads to the address in `host`",
     ResetRule::self_clearing, Reaction::warn, "A device with a watchdog of its own sets its outputs as it was told to"},
    {id(DeviceAlarm::silent), "modbus_silent",
     "The Modbus device does not answer in time: its inputs keep their last values and are not good",
     "Modbus 设备未及时应答:其输入保持最后的值且无效",
     "It has no supply or its cable is off; it is slower than `timeout`, `poll` and `max_age` say; or no device behind it has this `unit`",
     "Look at supply and cable, try `ping`; compare `unit` with the device; where it answers slowly raise `timeout`, `poll` and `max_age`",
     ResetRule::self_clearing, Reaction::warn, "A device with a watchdog of its own sets its outputs as it was told to"},
    {id(DeviceAlarm::closed), "modbus_closed", "The Modbus device ended the connection: its inputs keep their last values and are not good",
     "Modbus 设备断开了连接:其输入保持最后的值且无效",
     "It was restarted, it serves fewer clients than ask it, or it ends connections that are silent for long",
     "End other clients (a visualisation, a test tool), or allow more in the device's settings", ResetRule::self_clearing, Reaction::warn,
     "A device with a watchdog of its own sets its outputs as it was told to"},
    {id(DeviceAlarm::exception),
     "modbus_exception",
     "The Modbus device answers with exception {a}",
     "Modbus 设备返回异常码 {a}",
     "The device does not have what is asked for: see the code",
     "Compare table, address and type of the channels with the device's manual: addresses count from 0 here",
     ResetRule::self_clearing,
     Reaction::warn,
     {}},
    {id(DeviceAlarm::wrong_answer),
     "modbus_wrong_answer",
     "What answers is no Modbus device, or answers something else than was asked",
     "应答方不是 Modbus 设备,或应答与请求不符",
     "Another service listens at the port, a gateway mixes up answers, or the answer is shorter than its request wants",
     "Compare `host`, `port` and `unit` with the device; read it with another tool (mbpoll) to see who is wrong",
     ResetRule::self_clearing,
     Reaction::warn,
     {}},
}};
static_assert(alarm_table_is_sound(device_alarms, 0x2000, 0x2FFF));

}  // namespace taktwerk::modbus::tcp
