#include "apps/drive/line_session.hpp"

#include "apps/machine/stop_signal.hpp"
#include "modbus/line/tty_line.hpp"
#include "runtime/world/world.hpp"

namespace taktwerk::apps {

namespace {

using namespace std::chrono_literals;

constexpr Duration poll_period = 1ms;
constexpr Duration start_up = 2s;  // a simulated drive answers 1.5 s after its mains (XP200 4.7.1)

Error interrupted() { return Error{"bus.interrupted", "", "ended before it was done", ""}; }

}  // namespace

struct LineSession::Parts {
    std::unique_ptr<Clock> clock;
    std::unique_ptr<runtime::World> world;
    std::unique_ptr<modbus::TtyLine> port;
    std::unique_ptr<modbus::Client> client;
};

LineSession::LineSession() : parts_(std::make_unique<Parts>()) {}
LineSession::~LineSession() = default;

Result<std::unique_ptr<LineSession>> LineSession::open(const std::string& device, const modbus::LineSettings& settings) {
    auto port = modbus::TtyLine::open(device, settings);
    if (!port) return std::move(port).error();
    std::unique_ptr<LineSession> session(new LineSession);
    session->parts_->clock = std::make_unique<SystemClock>();
    session->parts_->port = std::move(*port);
    session->parts_->client = std::make_unique<modbus::Client>(*session->parts_->port);
    return session;
}

std::unique_ptr<LineSession> LineSession::simulate(const runtime::MachineConfig& machine, std::size_t index) {
    std::unique_ptr<LineSession> session(new LineSession);
    auto& parts = *session->parts_;
    parts.clock = std::make_unique<VirtualClock>();
    parts.world = std::make_unique<runtime::World>(machine, parts.clock->now());
    parts.client = std::make_unique<modbus::Client>(*parts.world->serial().lines()[index]);
    session->wait(start_up);
    return session;
}

Instant LineSession::now() const noexcept { return parts_->clock->now(); }

bool LineSession::tick() {
    auto& clock = *parts_->clock;
    clock.sleep_until(clock.now() + poll_period);
    if (parts_->world) parts_->world->apply_events(clock.now());
    return undisturbed_ || !stop_requested();
}

bool LineSession::wait(Duration time) {
    for (const auto end = now() + time; now() < end;) {
        if (!tick()) return false;
        (void)parts_->client->step(now());  // nothing is asked: the line lives on
    }
    return true;
}

Result<modbus::Answer> LineSession::ask(const modbus::Request& request) {
    auto& client = *parts_->client;
    for (auto refusal = client.ask(request, now()); refusal != modbus::Refusal::none; refusal = client.ask(request, now())) {
        if (refusal != modbus::Refusal::busy && refusal != modbus::Refusal::saving)
            return Error{"serial.request", "", std::string(modbus::name(refusal)), ""};
        if (!wait(poll_period)) return interrupted();
    }
    for (;;) {
        if (!tick()) return interrupted();
        if (auto answer = client.step(now())) return *answer;
    }
}

}  // namespace taktwerk::apps
