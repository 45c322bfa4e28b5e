#include "runtime/machine/drive_desk.hpp"

#include <algorithm>

namespace taktwerk::runtime {

using axes::ServiceAnswer;
using axes::ServiceTicket;

/// The service side of the axis' own port, by way of the desk.
class DriveDesk::Port final : public axes::DrivePort {
public:
    Port(DriveDesk& desk, std::size_t axis, axes::DrivePort& inner) : desk_(desk), axis_(static_cast<std::uint16_t>(axis)), inner_(inner) {}
    [[nodiscard]] const axes::DriveCapabilities& capabilities() const noexcept override { return inner_.capabilities(); }
    const axes::DriveFeedback& decode(Instant now) noexcept override { return inner_.decode(now); }
    void encode(const axes::DriveCommand& command, Instant now) noexcept override { inner_.encode(command, now); }
    [[nodiscard]] Instant setpoint_effective(Instant send_time) const noexcept override { return inner_.setpoint_effective(send_time); }
    [[nodiscard]] axes::DriveAlarm alarm() const noexcept override { return inner_.alarm(); }
    [[nodiscard]] ServiceTicket read_parameter(axes::ParameterAddress address) override {
        return desk_.ask({AskedKind::read, axis_, address});
    }
    [[nodiscard]] ServiceTicket write_parameter(axes::ParameterAddress address, std::vector<std::byte> value) override {
        return desk_.ask({AskedKind::write, axis_, address, {}, std::move(value)});
    }
    [[nodiscard]] ServiceTicket start_service(axes::DriveService service) override {
        return desk_.ask({AskedKind::service, axis_, {}, service});
    }
    [[nodiscard]] std::optional<Result<ServiceAnswer>> service_answer(ServiceTicket ticket) override { return desk_.answer(axis_, ticket); }
    [[nodiscard]] std::vector<std::string> setup_problems() const override { return inner_.setup_problems(); }

private:
    DriveDesk& desk_;
    std::uint16_t axis_;
    axes::DrivePort& inner_;
};

// What a drive on a line is asked goes to its line, and what comes of it is in its samples.
axes::DrivePort& DriveDesk::port(std::size_t axis) {
    if (body_.calls == nullptr || !drives_.on_bus(axis)) return drives_.port(axis);
    if (ports_.size() <= axis) ports_.resize(axis + 1);
    if (!ports_[axis]) ports_[axis] = std::make_unique<Port>(*this, axis, drives_.port(axis));
    return *ports_[axis];
}

ServiceTicket DriveDesk::ask(const AskedRecord& asked) {
    auto& port = drives_.port(asked.axis);
    ServiceTicket ticket = 0;
    switch (asked.kind) {
        case AskedKind::read: ticket = port.read_parameter(asked.address); break;
        case AskedKind::write: ticket = port.write_parameter(asked.address, asked.value); break;
        case AskedKind::service: ticket = port.start_service(asked.service); break;
        case AskedKind::ports: return 0;
    }
    if (ticket == 0) return 0;  // refused: nothing has come of it
    asked_.push_back(asked);
    flights_.push_back({asked.axis, ticket});
    return ticket;
}

bool DriveDesk::ask_again(const AskedRecord& asked) {
    return asked.axis < body_.axes.size() && drives_.on_bus(asked.axis) && ask(asked) != 0;
}

void DriveDesk::note(Instant now) {
    if (body_.calls != nullptr)
        for (const auto& asked : asked_) record_asked(*body_.calls, now, asked);
    asked_.clear();
}

void DriveDesk::collect() {
    std::erase_if(flights_, [this](const Flight& flight) {
        auto answered = drives_.port(flight.axis).service_answer(flight.ticket);
        if (!answered) return false;
        answers_.emplace_back(flight, *std::move(answered));
        if (answers_.size() > most_answers) answers_.pop_front();
        return true;
    });
}

std::optional<Result<ServiceAnswer>> DriveDesk::answer(std::size_t axis, ServiceTicket ticket) {
    const auto found =
        std::ranges::find_if(answers_, [&](const auto& one) { return one.first.axis == axis && one.first.ticket == ticket; });
    if (found == answers_.end()) return std::nullopt;
    auto answer = std::move(found->second);
    answers_.erase(found);
    return answer;
}

}  // namespace taktwerk::runtime
