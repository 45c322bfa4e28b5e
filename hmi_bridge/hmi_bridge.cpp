#include "hmi_bridge/hmi_bridge.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "hmi_bridge/lcm/lcm_bus.hpp"
#include "hmi_bridge/modbus/offer.hpp"
#include "hmi_bridge/socket/socket_path.hpp"

namespace taktwerk::hmi {
namespace {

std::string why_no_lcm(const HmiConfig& config, const std::optional<Error>& problem) {
    if (!config.lcm) return "the machine file says `lcm: {enabled: false}`";
    return problem ? problem->what + ". " + problem->remedy : std::string{};
}

}  // namespace

Result<std::unique_ptr<HmiBridge>> HmiBridge::open(const HmiConfig& config, MachineLink& machine, HmiOptions options) {
    if (auto errors = check(config); !errors.empty()) return errors.front();
    if (!options.log) options.log = [](std::string_view) {};

    auto path = config.socket.empty() ? make_socket_path(machine.layout().machine) : Result<std::string>(config.socket);
    if (!path) return path.error();
    auto server = SocketServer::open(*path, options.log, config.socket_group);
    if (!server) return server.error();

    std::optional<Error> problem;
    if (config.lcm && !options.bus) {
        const auto url = parse_lcm_url(config.lcm_url);
        auto bus = LcmBus::open(*url);
        if (bus) options.bus = std::move(bus).value();
        else problem = bus.error();
    }
    if (problem && config.lcm_required) return *problem;
    if (problem) options.log("the state is not published over LCM: " + problem->text());
    options.log(fmt::format("commands are taken at {} from {}", *path, (*server)->who_may_connect()));
    if (config.lcm && config.lcm_commands == LcmCommands::local)
        options.log("commands are taken over LCM, too: from every process of every user of this computer");
    const auto log = options.log;
    auto bridge =
        std::unique_ptr<HmiBridge>(new HmiBridge(config, machine, std::move(options), std::move(server).value(), std::move(problem)));
    if (config.modbus_server) {
        auto desk = ModbusDesk::open(*config.modbus_server, names_of(machine.layout()), bridge->gateway_,
                                     [log](std::string_view text) { log(fmt::format("Modbus TCP server: {}", text)); });
        if (!desk) return desk.error();
        bridge->modbus_ = std::move(desk).value();
        log(offered_text(*config.modbus_server));
    }
    return bridge;
}

HmiBridge::HmiBridge(const HmiConfig& config, MachineLink& machine, HmiOptions options, std::unique_ptr<SocketServer> server,
                     std::optional<Error> lcm_problem)
    : machine_(machine),
      bus_(std::move(options.bus)),
      lcm_problem_(std::move(lcm_problem)),
      channels_(machine.layout().machine),
      gateway_(machine, options.log),
      requests_(gateway_, machine, options.wall_utime, options.log),
      receiver_(gateway_, options.wall_utime),
      door_(machine, std::move(server), options.log),
      door_thread_(options.door),
      wall_utime_(options.wall_utime) {
    requests_.set_simulate(std::move(options.simulate));
    requests_.set_about(std::move(options.about));
    requests_.set_log(std::move(options.log_tail));
    requests_.set_recorder(options.recorder);
    requests_.set_run_memory(options.run_memory);
    requests_.set_views(std::move(options.views));
    JsonRequests::LcmTold lcm{config.lcm ? config.lcm_url : std::string{}, why_no_lcm(config, lcm_problem_), config.rate_hz, 0};
    if (bus_) lcm.run = std::max<std::int64_t>(options.wall_utime(), 1);
    const auto run = lcm.run;
    requests_.set_lcm(std::move(lcm));
    if (!bus_) return;
    const bool commands = config.lcm_commands == LcmCommands::local;
    publisher_.emplace(*bus_, machine, config.rate_hz, commands, options.wall_utime);
    publisher_->publish_whole_states(run, [this](ClientId client) { return gateway_.name_of(client); });
    if (commands) bus_->subscribe(channels_.command(), [this](std::span<const std::byte> message) { receiver_.receive(message, now_); });
}

void HmiBridge::step(Instant now) {
    now_ = now;
    snapshot_ = machine_.latest();
    gateway_.observe(snapshot_ != nullptr);
    requests_.observe(snapshot_);
    if (history_ && snapshot_) history_->look(*snapshot_, now, wall_utime_());

    gateway_.step(now);  // answers to what was asked before
    if (door_thread_ == DoorThread::service) door_.step(now);
    door_.pass_on(requests_, now);
    if (modbus_) modbus_->step(snapshot_, now);
    if (modbus_ && door_thread_ == DoorThread::service) modbus_->server().step(now);
    requests_.step(now);
    if (bus_) bus_->poll(lcm_messages_per_step);
    while (const auto reply = gateway_.next_reply()) {
        if (reply->source == Source::socket) requests_.deliver(*reply);
        else if (reply->source == Source::modbus) modbus_->deliver(*reply);
        else if (bus_) receiver_.deliver(*reply, *bus_, channels_);
    }
    while (auto line = requests_.next_line()) door_.answer(line->connection, std::move(line->text), std::move(line->refused));
    if (door_thread_ == DoorThread::service) door_.send_answers();
    // A stuck cycle's values must look old: the heartbeat falls silent, too (heartbeat_v1_t).
    if (publisher_ && !machine_.stuck()) publisher_->step(snapshot_, now);
}

}  // namespace taktwerk::hmi
