#pragma once
// Two network namespaces with a veth cable between them, for tests whose master and slaves are two processes. Needs root.

#include <unistd.h>

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "tests/apps/child.hpp"

namespace taktwerk::apps {

inline int run(std::vector<std::string> words, std::string* text = nullptr) {
    Child child(std::move(words));
    const int code = child.wait(std::chrono::seconds{20});
    if (text) *text = child.text();
    return code;
}

/// Two namespaces with a cable between them; gone at the end.
class Cable {
public:
    Cable() : master_("twk-m" + std::to_string(::getpid())), slaves_("twk-s" + std::to_string(::getpid())) {
        laid_ = run({"ip", "netns", "add", master_}) == 0 && run({"ip", "netns", "add", slaves_}) == 0 &&
                run({"ip", "link", "add", "twk0", "netns", master_, "type", "veth", "peer", "name", "twk1", "netns", slaves_}) == 0 &&
                quiet(master_, "twk0") && quiet(slaves_, "twk1");
    }
    ~Cable() {
        run({"ip", "netns", "del", master_});
        run({"ip", "netns", "del", slaves_});
    }
    Cable(const Cable&) = delete;
    Cable& operator=(const Cable&) = delete;

    /// A second one beside it, twk2 at the master and twk3 at the slaves: two interfaces, a ring.
    [[nodiscard]] bool lay_second() const {
        return run({"ip", "link", "add", "twk2", "netns", master_, "type", "veth", "peer", "name", "twk3", "netns", slaves_}) == 0 &&
               quiet(master_, "twk2") && quiet(slaves_, "twk3");
    }
    [[nodiscard]] const std::string& master_end() const { return master_; }
    [[nodiscard]] bool laid() const { return laid_; }
    [[nodiscard]] std::vector<std::string> at_master(std::vector<std::string> words) const { return in(master_, std::move(words)); }
    [[nodiscard]] std::vector<std::string> at_slaves(std::vector<std::string> words) const { return in(slaves_, std::move(words)); }

private:
    /// Up, and without IPv6's own frames: the cable belongs to EtherCAT.
    static bool quiet(const std::string& where, const std::string& nic) {
        run(in(where, {"sysctl", "-q", "-w", "net.ipv6.conf." + nic + ".disable_ipv6=1"}));
        return run(in(where, {"ip", "link", "set", nic, "up"})) == 0;
    }
    static std::vector<std::string> in(const std::string& where, std::vector<std::string> words) {
        words.insert(words.begin(), {"ip", "netns", "exec", where});
        return words;
    }
    std::string master_, slaves_;
    bool laid_ = false;
};

}  // namespace taktwerk::apps
