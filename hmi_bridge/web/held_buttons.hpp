#pragma once
// Which buttons of a view one page holds, by what the machine took: a renewal of them is not written down, each other value is. Not thread-safe.

#include <algorithm>
#include <string>
#include <vector>

#include "hmi_bridge/web/page_message.hpp"

namespace taktwerk::hmi::web {

class HeldButtons {
public:
    static constexpr std::size_t most = 16;

    /// Of a jog or a measurement the machine knows whether it is one.
    [[nodiscard]] bool is_renewal(const PageMessage& message) const {
        return message.is_renewal() && (message.is_jog() || std::find(held_.begin(), held_.end(), message.variable()) != held_.end());
    }
    /// The machine has taken it.
    void taken(const PageMessage& message) {
        if (message.rule->command != "set_value" || message.is_renewal()) return;
        std::erase(held_, message.variable());
        if (!message.is_held() || !message.may_move()) return;
        if (held_.size() >= most) held_.erase(held_.begin());
        held_.push_back(message.variable());
    }
    void clear() { held_.clear(); }

private:
    std::vector<std::string> held_;
};

}  // namespace taktwerk::hmi::web
