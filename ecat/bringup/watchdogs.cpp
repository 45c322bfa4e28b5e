#include "ecat/bringup/watchdogs.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace taktwerk::ecat {

namespace {

Script<Result<void>> write_and_read_back(Bus& bus, const BusSlave& slave, std::uint16_t address, std::uint16_t value, std::string name) {
    const Reply written = co_await bus.port.fpwr(slave.found.station, address, value);
    if (!written.ok()) co_return unanswered(slave.subject, name, written);
    const Reply back = co_await bus.port.fprd(slave.found.station, address, 2);
    if (!back.ok()) co_return unanswered(slave.subject, name, back);
    if (back.u16() != value)
        co_return Error{"bus.watchdog", slave.subject, fmt::format("its {} reads back {} after {} was written", name, back.u16(), value),
                        "its controller has a fixed watchdog: check in its manual when it reacts to a dead master"};
    co_return Result<void>{};
}

}  // namespace

std::uint16_t watchdog_ticks(Duration time) noexcept {
    return static_cast<std::uint16_t>(std::min<std::int64_t>(0xFFFF, (time + watchdog_tick - Duration{1}) / watchdog_tick));
}

Script<Result<void>> program_watchdogs(Bus& bus, BusSlave& slave) {
    const bool needed = bus.plan.slaves[slave.index].outputs.size > 0;
    Result<void> done =
        co_await write_and_read_back(bus, slave, reg::watchdog_divider, reg::watchdog_divider_default, "watchdog divider (0400h)");
    if (done)
        done = co_await write_and_read_back(bus, slave, reg::sm_watchdog_time, watchdog_ticks(sm_watchdog(bus.config, *slave.config)),
                                            "SM watchdog (0420h)");
    if (!done && needed) co_return done;
    if (slave.config->pdi_watchdog > Duration{})
        co_return co_await write_and_read_back(bus, slave, reg::pdi_watchdog_time, watchdog_ticks(slave.config->pdi_watchdog),
                                               "PDI watchdog (0410h)");
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
