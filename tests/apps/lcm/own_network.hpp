#pragma once
// A network namespace of a test's own, with multicast over loopback as docs/lcm.md sets it up, and children in it. Needs no root where the system lets users have one.

#include <chrono>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/child.hpp"

namespace taktwerk::apps {

class OwnNetwork {
public:
    OwnNetwork()
        : holder_({"unshare", "--user", "--map-root-user", "--net", "sh", "-c",
                   "ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo && echo holder $$ ready && exec "
                   "sleep 300"}) {
        if (!holder_.says(" ready", std::chrono::seconds{20})) return;
        const auto& text = holder_.text();
        process_ = text.substr(text.find("holder ") + 7);
        process_ = process_.substr(0, process_.find(' '));
    }
    /// False: the system allows none.
    [[nodiscard]] bool made() const { return !process_.empty(); }
    [[nodiscard]] std::vector<std::string> in(std::vector<std::string> words) const {
        words.insert(words.begin(), {"nsenter", "--target", process_, "--user", "--net", "--preserve-credentials"});
        return words;
    }

private:
    Child holder_;
    std::string process_;
};

}  // namespace taktwerk::apps
