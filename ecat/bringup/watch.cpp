#include "ecat/bringup/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include "ecat/bringup/al_control.hpp"
#include "ecat/bringup/recovery.hpp"
#include "ecat/bringup/reference_role.hpp"
#include "ecat/dc/propagation.hpp"

namespace taktwerk::ecat {

namespace {

constexpr Duration watch_period = std::chrono::milliseconds{100};
constexpr Duration watch_glance = std::chrono::milliseconds{5};       ///< how soon a state the cycle saw is noticed
constexpr Duration watch_suspicious = std::chrono::milliseconds{20};  ///< instead of watch_period, while one slave is not in OP
constexpr Duration retry_period = std::chrono::milliseconds{500};     ///< between two attempts to get a slave back

Script<void> watch(Bus& bus, BusSlave& slave) {
    bool reported = false;
    Instant look = co_await time();
    Instant last_difference = look;
    for (;;) {
        Instant now = co_await pause(watch_glance);
        constexpr auto all_op = static_cast<std::uint32_t>(AlState::op);
        const bool suspicious = bus.link.states_seen.load() != all_op;
        if (now < look && !(suspicious && now >= look - watch_period + watch_suspicious)) continue;
        look = now + watch_period;

        const Result<std::uint16_t> status = co_await read_al_status(bus, slave);
        if (!status) slave.al.store(0);
        if (status && *status == all_op) {
            reported = false;
            if (slave.dc && bus.reference != slave.index && now - last_difference >= std::chrono::seconds{1}) {
                last_difference = now;
                const Reply reply = co_await bus.port.fprd(slave.found.station, reg::dc_difference, 4);
                if (reply.ok()) slave.dc_difference = std::abs(static_cast<std::int64_t>(dc_difference_ns(reply.u32())));
                std::int64_t worst = 0;
                for (const auto& other : bus.slaves) worst = std::max(worst, other->dc_difference);
                bus.link.dc_difference_ns.store(worst);
            }
            continue;
        }
        if (!reported)
            bus.remember(status ? fmt::format("{} left OP: status 0x{:04X}, code 0x{:04X} {}", slave.subject, *status,
                                              slave.al.load() >> 16, al_status_info(static_cast<std::uint16_t>(slave.al.load() >> 16)).text)
                                : status.error().text());
        const Result<void> back = co_await recover(bus, slave);
        if (back) {
            slave.recoveries.fetch_add(1);
            bus.remember(slave.subject + " is back in OP");
            reported = false;
        } else {
            if (!reported) bus.remember(back.error().text());
            reported = true;
            co_await pause(retry_period);
        }
    }
}

}  // namespace

Script<void> keep_alive(Bus& bus) {
    std::vector<Script<void>> scripts;
    for (auto& slave : bus.slaves) {
        scripts.push_back(watch(bus, *slave));
        if (slave->has_coe()) scripts.push_back(listen(bus.port, slave->mailbox));
    }
    scripts.push_back(watch_reference(bus));
    co_await all(std::move(scripts));
}

}  // namespace taktwerk::ecat
