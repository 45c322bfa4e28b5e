#pragma once
// The machine's side of the Modbus TCP server: after each cycle its values become registers, and what clients write becomes commands of people, through
// the gateway as every other (`set_output`, `set_parameter`). Service side, one thread, not real-time.

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "hmi_bridge/gateway/gateway.hpp"
#include "hmi_bridge/modbus/shown_value.hpp"
#include "modbus/server/server.hpp"

namespace taktwerk::hmi {

class ModbusDesk {
public:
    /// Of one client, on their way to the cycle at once.
    static constexpr std::size_t commands_at_once = 8;

    /// Listens. Errors: served.listen; the first of check() with `names`.
    static Result<std::unique_ptr<ModbusDesk>> open(const ModbusServerConfig& config, const ShownNames& names, Gateway& gateway,
                                                    std::function<void(std::string_view)> log);

    [[nodiscard]] modbus::server::Server& server() noexcept { return *server_; }

    /// `snapshot`: the newest one; nullptr before the first cycle.
    void step(const runtime::Snapshot* snapshot, Instant now);
    /// A reply of the gateway with Source::modbus.
    void deliver(const CommandReply& reply);

private:
    struct Bound {
        ModbusPoint point;
        BoundValue value;
    };
    /// A write request on its way: a command for each of its registers.
    struct Job {
        std::uint64_t order = 0;
        ClientId client = 0;
        Instant at{};
        std::vector<modbus::server::RegisterChange> changes;
        std::size_t next = 0, under_way = 0;
        modbus::server::Exception worst = modbus::server::Exception::none;
    };
    struct Client {
        ClientId id = 0;
        std::uint64_t sequence = 0;
    };

    ModbusDesk(std::vector<Bound> points, std::unique_ptr<modbus::server::Server> server, Gateway& gateway);
    void publish(const runtime::Snapshot& snapshot);
    void take_orders();
    void go_on(Job& job, Instant now);
    void finish_jobs();

    std::vector<Bound> points_;
    std::unique_ptr<modbus::server::Server> server_;
    Gateway& gateway_;
    std::map<std::uint64_t, Client> clients_;  // by connection
    std::deque<Job> jobs_;
    std::uint64_t published_ = 0;  // cycle
};

}  // namespace taktwerk::hmi
