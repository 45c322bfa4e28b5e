#pragma once
// Parameters and services that somebody asked for: one after another, each answered once. Service side.

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "axes/port/drive_port.hpp"
#include "modbus/client/client.hpp"

namespace taktwerk::axes::xp200 {

struct Service {
    ServiceTicket ticket = 0;
    modbus::Request request;
};

class ServiceQueue {
public:
    static constexpr std::size_t room = 64;
    static constexpr unsigned pace = 4;

    /// Full: false.
    bool push(const Service& service) {
        if (waiting_.size() >= room) return false;
        waiting_.push_back(service);
        return true;
    }
    /// Asked before each question to the drive: one of `pace` is for the first that waits, the others are the poll's.
    [[nodiscard]] bool its_turn() noexcept { return !waiting_.empty() && ++asked_ % pace == 0; }
    /// The next one is under way. Only when it is its turn.
    [[nodiscard]] modbus::Request begin() {
        const auto service = waiting_.front();
        waiting_.pop_front();
        under_way_ = service.ticket;
        return service.request;
    }
    void answered(const modbus::Answer& answer) {
        served_ = {under_way_, answer};
        under_way_ = 0;
    }
    /// Once.
    std::optional<std::pair<ServiceTicket, modbus::Answer>> served() { return std::exchange(served_, std::nullopt); }

private:
    std::deque<Service> waiting_;
    std::optional<std::pair<ServiceTicket, modbus::Answer>> served_;
    ServiceTicket under_way_ = 0;
    unsigned asked_ = 0;
};

}  // namespace taktwerk::axes::xp200
