#include "hmi_bridge/modbus/modbus_desk.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace taktwerk::hmi {

using modbus::server::Exception;

namespace {

/// What a refusal is called on this bus (docs/modbus-tcp.md): a value that cannot be, or a machine that does not take it now.
Exception exception_of(runtime::Answer answer) noexcept {
    switch (answer) {
        case runtime::Answer::accepted: return Exception::none;
        case runtime::Answer::bad_value: return Exception::illegal_value;
        case runtime::Answer::unknown_name: return Exception::illegal_address;
        default: return Exception::server_failure;
    }
}

}  // namespace

Result<std::unique_ptr<ModbusDesk>> ModbusDesk::open(const ModbusServerConfig& config, const ShownNames& names, Gateway& gateway,
                                                     std::function<void(std::string_view)> log) {
    if (auto errors = check(config, names); !errors.empty()) return errors.front();
    std::vector<Bound> points;
    std::vector<modbus::server::ServedRegister> registers;
    for (const auto& point : config.points) {
        auto bound = bind(point.shows, names);
        if (!bound)
            return Error{"served.unknown_name", "modbus_server.points." + point.place.name,
                         fmt::format("there is no {}", text_of(point.shows)), "correct the name"};
        points.push_back({point, std::move(*bound)});
        registers.push_back(point.place);
    }
    auto server = modbus::server::Server::open(config.server, std::move(registers), std::move(log));
    if (!server) return server.error();
    return std::unique_ptr<ModbusDesk>(new ModbusDesk(std::move(points), std::move(server).value(), gateway));
}

ModbusDesk::ModbusDesk(std::vector<Bound> points, std::unique_ptr<modbus::server::Server> server, Gateway& gateway)
    : points_(std::move(points)), server_(std::move(server)), gateway_(gateway) {}

void ModbusDesk::step(const runtime::Snapshot* snapshot, Instant now) {
    if (snapshot != nullptr && snapshot->cycle != published_) publish(*snapshot);
    take_orders();
    for (auto& job : jobs_) go_on(job, now);
    finish_jobs();
}

void ModbusDesk::publish(const runtime::Snapshot& snapshot) {
    auto& image = server_->image();
    image.ever = true;
    image.at = snapshot.at;
    for (std::size_t i = 0; i < points_.size(); ++i) {
        const auto& [point, value] = points_[i];
        image.words[i] = words_of(point.place, value_of(value, point.place, snapshot) * point.factor + point.offset);
    }
    server_->publish();
    published_ = snapshot.cycle;
}

void ModbusDesk::take_orders() {
    while (auto order = server_->orders().next_order()) {
        auto& client = clients_[order->connection];
        if (client.id == 0) client.id = gateway_.open(Source::modbus, "Modbus client " + order->who, Rights::operating);
        Job job{order->id, client.id, order->at, std::move(order->changes)};
        if (client.id == 0) job.worst = Exception::server_failure;  // too many clients
        jobs_.push_back(std::move(job));
    }
    while (const auto gone = server_->orders().next_gone()) {
        const auto found = clients_.find(*gone);
        if (found == clients_.end()) continue;
        std::erase_if(jobs_, [&](const Job& job) { return job.client == found->second.id; });
        if (found->second.id != 0) gateway_.close(found->second.id);
        clients_.erase(found);
    }
}

void ModbusDesk::go_on(Job& job, Instant now) {
    const auto client = std::ranges::find(clients_, job.client, [](const auto& c) { return c.second.id; });
    while (job.worst == Exception::none && job.next < job.changes.size() && job.under_way < commands_at_once) {
        const auto& change = job.changes[job.next++];
        const auto& [point, value] = points_[change.index];
        CommandRequest request;
        request.client = job.client;
        request.sequence = ++client->second.sequence;
        request.kind = value.of == ShownValue::Of::output ? CommandKind::set_output : CommandKind::set_parameter;
        request.target = point.shows.name;
        request.value = (change.number - point.offset) / point.factor;
        request.arrival.at = job.at;
        ++job.under_way;
        gateway_.handle(request, now);
    }
}

void ModbusDesk::deliver(const CommandReply& reply) {
    const auto job = std::ranges::find(jobs_, reply.client, &Job::client);  // a client has one at a time
    if (job == jobs_.end() || job->under_way == 0) return;
    --job->under_way;
    if (job->worst == Exception::none) job->worst = exception_of(reply.answer);
}

void ModbusDesk::finish_jobs() {
    std::erase_if(jobs_, [&](const Job& job) {
        const bool done = job.under_way == 0 && (job.worst != Exception::none || job.next == job.changes.size());
        if (done) server_->orders().judge({job.order, job.worst});
        return done;
    });
}

}  // namespace taktwerk::hmi
