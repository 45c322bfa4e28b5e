#pragma once
// Which client has its hand on which axis: who took control of it, powered it or moved it last, as long as it is there. Refuses nobody by
// itself. One thread, not real-time.

#include <cstdint>
#include <map>
#include <string>

namespace taktwerk::hmi {

class Hands {
public:
    struct Hand {
        std::uint32_t client = 0;
        std::string name;
    };

    void lay(std::uint16_t axis, std::uint32_t client, const std::string& name) { hands_[axis] = {client, name}; }
    void lift(std::uint16_t axis, std::uint32_t client) {
        if (const auto found = hands_.find(axis); found != hands_.end() && found->second.client == client) hands_.erase(found);
    }
    /// The client is gone.
    void lift_all(std::uint32_t client) {
        std::erase_if(hands_, [&](const auto& hand) { return hand.second.client == client; });
    }
    /// nullptr: nobody that is still there.
    [[nodiscard]] const Hand* on(std::uint16_t axis) const {
        const auto found = hands_.find(axis);
        return found == hands_.end() ? nullptr : &found->second;
    }

private:
    std::map<std::uint16_t, Hand> hands_;
};

}  // namespace taktwerk::hmi
