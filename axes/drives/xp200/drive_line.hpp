#pragma once
// The drives that share one line, asked in turn; whoever has to stop goes first. Service side: step(now), often.

#include <memory>
#include <vector>

#include "axes/drives/xp200/xp200_drive.hpp"
#include "modbus/client/client.hpp"

namespace taktwerk::axes::xp200 {

class DriveLine {
public:
    /// `line` outlives this.
    explicit DriveLine(modbus::SerialLine& line, const modbus::ClientConfig& config = {}) : client_(line, config) {}

    /// Outlives this.
    void add(Xp200Drive& drive) { drives_.push_back(&drive); }
    void step(Instant now);
    [[nodiscard]] const modbus::Client& client() const noexcept { return client_; }

private:
    bool ask(Xp200Drive& drive, Instant now);

    modbus::Client client_;
    std::vector<Xp200Drive*> drives_;
    std::size_t turn_ = 0;
    Xp200Drive* asking_ = nullptr;
};

}  // namespace taktwerk::axes::xp200
