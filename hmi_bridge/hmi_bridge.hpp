#pragma once
// Everything between one machine and its people: LCM state out, commands in from the local socket and (where allowed) LCM. The
// service loop calls step() about each 5 ms; no thread of its own, nothing here is real-time. The door (door.hpp) may be stepped by
// another thread: then no work of the service side holds up a stop.
//
//   auto bridge = HmiBridge::open(config, link, {.log = print});
//   while (running) { machine.service(now); bridge->step(now); ... }

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/result.hpp"
#include "core/time.hpp"
#include "hmi_bridge/gateway/gateway.hpp"
#include "hmi_bridge/history/alarm_history.hpp"
#include "hmi_bridge/hmi_config.hpp"
#include "hmi_bridge/lcm/lcm_commands.hpp"
#include "hmi_bridge/lcm/message_bus.hpp"
#include "hmi_bridge/lcm/publisher.hpp"
#include "hmi_bridge/machine_link.hpp"
#include "hmi_bridge/modbus/modbus_desk.hpp"
#include "hmi_bridge/socket/door.hpp"
#include "hmi_bridge/socket/json_requests.hpp"
#include "hmi_bridge/socket/socket_server.hpp"
#include "hmi_bridge/wall_clock.hpp"

namespace taktwerk::hmi {

/// Who steps the door.
enum class DoorThread : std::uint8_t {
    service,  ///< HmiBridge::step()
    own,      ///< the caller, on a thread of its own; `log` is then called by both
};

struct HmiOptions {
    std::function<void(std::string_view)> log;                   ///< lines for the runtime's log; may be empty
    std::function<std::int64_t()> wall_utime = hmi::wall_utime;  ///< us since 1970; tests give their own
    std::unique_ptr<MessageBus> bus;                             ///< instead of the configured LCM: tests
    DoorThread door = DoorThread::service;
    ViewAnswers views{};                          ///< the machine builder's own pages
    runtime::FlightRecorder* recorder = nullptr;  ///< recordings around alarms; outlives the bridge
    runtime::RunMemory* run_memory = nullptr;     ///< the run so far; outlives the bridge
    JsonRequests::Simulate simulate{};            ///< hands on a simulated machine; empty: it is real
    JsonRequests::About about{};                  ///< what runs here, for "hello"
    std::shared_ptr<const LogTail> log_tail{};    ///< for "log"; may be null
};

class HmiBridge {
public:
    static constexpr int lcm_messages_per_step = 64;

    /// `machine` outlives the bridge. Errors: those of check(config), of the socket, of the Modbus server, and of LCM when it is required. Without
    /// that, a machine whose LCM does not work runs on: lcm_problem() says why.
    static Result<std::unique_ptr<HmiBridge>> open(const HmiConfig& config, MachineLink& machine, HmiOptions options);

    void step(Instant now);
    /// What alarms are kept in; step() looks, somebody else's thread writes. Before the first step.
    void keep(std::shared_ptr<AlarmHistory> history) {
        history_ = std::move(history);
        requests_.set_history(history_.get());
    }
    [[nodiscard]] Door& door() noexcept { return door_; }
    /// Of the configuration; nullptr: none. Stepped by step(), or where the door has a thread of its own by another of the caller's.
    [[nodiscard]] modbus::server::Server* modbus_server() noexcept { return modbus_ ? &modbus_->server() : nullptr; }
    /// How the start is getting on, for clients that ask before the first cycle (Machine::bus_progress()).
    void set_progress(std::string progress) { requests_.set_progress(std::move(progress)); }

    [[nodiscard]] const std::optional<Error>& lcm_problem() const noexcept { return lcm_problem_; }
    [[nodiscard]] const std::string& socket_path() const noexcept { return door_.path(); }
    [[nodiscard]] std::uint64_t lcm_rejected() const noexcept { return receiver_.rejected(); }
    /// The snapshot of the last step; for whoever shares the service thread. Until the next step.
    [[nodiscard]] const runtime::Snapshot* snapshot() const noexcept { return snapshot_; }

private:
    HmiBridge(const HmiConfig& config, MachineLink& machine, HmiOptions options, std::unique_ptr<SocketServer> server,
              std::optional<Error> lcm_problem);

    MachineLink& machine_;
    std::unique_ptr<MessageBus> bus_;  ///< null: LCM is off or does not work
    std::optional<Error> lcm_problem_;
    Channels channels_;
    Gateway gateway_;
    JsonRequests requests_;
    LcmCommandReceiver receiver_;
    std::optional<Publisher> publisher_;
    Door door_;
    DoorThread door_thread_;
    std::unique_ptr<ModbusDesk> modbus_;
    std::shared_ptr<AlarmHistory> history_;
    std::function<std::int64_t()> wall_utime_;
    const runtime::Snapshot* snapshot_ = nullptr;
    Instant now_{};
};

}  // namespace taktwerk::hmi
