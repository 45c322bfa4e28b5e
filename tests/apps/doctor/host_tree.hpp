#pragma once
// A computer as a tree of invented files, and network ports that are asked and set in memory.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "apps/doctor/ethernet_port.hpp"
#include "apps/doctor/host_files.hpp"

namespace taktwerk::apps::test {

class HostTree {
public:
    HostTree() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-doctor-XXXXXX").string();
        root_ = ::mkdtemp(pattern.data());
    }
    ~HostTree() {
        std::error_code ignored;
        std::filesystem::remove_all(root_, ignored);
    }
    HostTree(const HostTree&) = delete;
    HostTree& operator=(const HostTree&) = delete;

    HostTree& put(const std::string& path, const std::string& text) {
        std::filesystem::create_directories(at(path).parent_path());
        std::ofstream(at(path), std::ios::binary) << text;
        return *this;
    }
    HostTree& link(const std::string& path, const std::string& to) {
        std::filesystem::create_directories(at(path).parent_path());
        std::filesystem::create_symlink(to, at(path));
        return *this;
    }
    [[nodiscard]] std::filesystem::path at(const std::string& path) const { return root_ / path.substr(1); }
    [[nodiscard]] std::string text(const std::string& path) const {
        std::ifstream file(at(path), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    [[nodiscard]] bool has(const std::string& path) const { return std::filesystem::exists(at(path)); }
    [[nodiscard]] const std::filesystem::path& root() const { return root_; }
    [[nodiscard]] HostFiles files() const { return HostFiles{root_}; }
    /// Every file with its text, every folder: what has to be the same behind a revert.
    [[nodiscard]] std::map<std::string, std::string> everything() const {
        std::map<std::string, std::string> all;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root_)) {
            const auto name = entry.path().lexically_relative(root_).string();
            all[name] = entry.is_regular_file() ? text("/" + name) : "(folder)";
        }
        return all;
    }

private:
    std::filesystem::path root_;
};

/// An industrial PC as its maker delivers it: Debian 12, no real time, power saving, swap, two cores with two threads each.
inline void delivered(HostTree& host) {
    host.put("/proc/sys/kernel/osrelease", "6.1.0-28-amd64\n")
        .put("/proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC Debian 6.1.119-1 (2024-11-22)\n")
        .put("/proc/cmdline", "BOOT_IMAGE=/boot/vmlinuz-6.1.0-28-amd64 root=UUID=1 ro quiet\n")
        .put("/proc/cpuinfo", "processor\t: 0\nflags\t\t: fpu vme tsc msr constant_tsc\n")
        .put("/sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet\n")
        .put("/sys/devices/system/clocksource/clocksource0/available_clocksource", "hpet acpi_pm \n")
        .put("/proc/sys/kernel/sched_rt_runtime_us", "950000\n")
        .put("/proc/sys/kernel/sched_rt_period_us", "1000000\n")
        .put("/sys/devices/system/cpu/online", "0-3\n")
        .put("/sys/devices/system/cpu/isolated", "\n")
        .put("/sys/devices/system/cpu/smt/active", "1\n")
        .put("/sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "1,3\n")
        .put("/proc/meminfo", "MemTotal:       8000000 kB\nSwapTotal:       999424 kB\n")
        .put("/sys/kernel/mm/transparent_hugepage/enabled", "[always] madvise never\n")
        .put("/proc/sys/vm/compact_unevictable_allowed", "1\n")
        .put("/proc/sys/kernel/numa_balancing", "1\n")
        .put("/sys/devices/system/node/online", "0\n")
        .put("/proc/sys/net/core/rmem_max", "212992\n")
        .put("/proc/self/limits",
             "Limit                     Soft Limit           Hard Limit           Units     \n"
             "Max locked memory         8388608              8388608              bytes     \n"
             "Max realtime priority     0                    0                    \n")
        .put("/proc/self/status", "Name:\ttaktwerk\nCapEff:\t0000000000000000\n")
        .put("/proc/17/comm", "irqbalance\n")
        .put("/proc/sys/kernel/random/boot_id", "boot-1\n");
    for (const auto* cpu : {"0", "1", "2", "3"}) {
        const auto folder = "/sys/devices/system/cpu/cpu" + std::string(cpu);
        host.put(folder + "/cpufreq/scaling_governor", "powersave\n")
            .put(folder + "/cpufreq/cpuinfo_min_freq", "800000\n")
            .put(folder + "/cpufreq/cpuinfo_max_freq", "3200000\n")
            .put(folder + "/cpuidle/state0/name", "POLL\n")
            .put(folder + "/cpuidle/state0/latency", "0\n")
            .put(folder + "/cpuidle/state1/name", "C1\n")
            .put(folder + "/cpuidle/state1/latency", "2\n")
            .put(folder + "/cpuidle/state2/name", "C6\n")
            .put(folder + "/cpuidle/state2/latency", "133\n")
            .put(folder + "/cpuidle/state2/disable", "0\n");
    }
}

/// The same one set up: PREEMPT_RT, CPU 3 isolated, no power saving.
inline void set_up(HostTree& host) {
    delivered(host);
    host.put("/proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian 6.1.119-1 (2024-11-22)\n")
        .put("/proc/cmdline", "root=UUID=1 ro isolcpus=2,3 nohz_full=2,3 rcu_nocbs=2,3\n")
        .put("/sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n")
        .put("/sys/devices/system/cpu/isolated", "2-3\n")
        .put("/sys/devices/system/cpu/nohz_full", "2-3\n")
        .put("/sys/devices/system/cpu/smt/active", "0\n")
        .put("/sys/devices/system/cpu/cpu3/topology/thread_siblings_list", "3\n")
        .put("/sys/kernel/mm/transparent_hugepage/enabled", "always [madvise] never\n")
        .put("/proc/sys/vm/compact_unevictable_allowed", "0\n")
        .put("/proc/sys/net/core/rmem_max", "2097152\n")
        .put("/proc/self/status", "CapEff:\t0000000000804000\n")  // CAP_SYS_NICE (23) and CAP_IPC_LOCK (14)
        .put("/dev/cpu_dma_latency", "")
        .put("/proc/17/comm", "cron\n");
    for (const auto* cpu : {"0", "1", "2", "3"})
        host.put("/sys/devices/system/cpu/cpu" + std::string(cpu) + "/cpufreq/scaling_governor", "performance\n");
}

/// A port that nobody but the bus uses, with a slave at its other end.
inline void free_port(HostTree& host) {
    const std::string folder = "/sys/class/net/eth1/";
    host.put(folder + "ifindex", "3\n")
        .put(folder + "flags", "0x1003\n")
        .put(folder + "carrier", "1\n")
        .put(folder + "speed", "100\n")
        .put(folder + "duplex", "full\n")
        .link(folder + "device/subsystem", "../../../bus/pci")
        .put("/proc/sys/net/ipv6/conf/eth1/disable_ipv6", "1\n")
        .put("/proc/net/packet", "sk               RefCnt Type Proto  Iface R Rmem   User   Inode\n")
        .put("/proc/net/route", "Iface\tDestination\tGateway\neth0\t00000000\t0102000A\n");
}

class MemoryPorts final : public EthernetPorts {
public:
    std::map<std::string, EthernetSettings> settings;
    bool refuses = false;
    std::optional<std::vector<std::string>> sockets_have;  ///< nothing: what the tree shows
    std::uint32_t least_us = 0;                            ///< a driver that takes no less, and says so only when it is asked

    [[nodiscard]] std::optional<std::vector<std::string>> names() const override { return sockets_have; }
    [[nodiscard]] EthernetSettings read(const std::string& interface) const override {
        const auto found = settings.find(interface);
        return found == settings.end() ? EthernetSettings{} : found->second;
    }
    [[nodiscard]] Result<void> set(const std::string& interface, EthernetKnob knob, std::uint32_t value) override {
        if (refuses) return Error{"doctor.ethernet", interface, "its driver does not take it", ""};
        auto& s = settings[interface];
        switch (knob) {
            case EthernetKnob::receive_us: s.receive_us = std::max(value, least_us); break;
            case EthernetKnob::send_us: s.send_us = value; break;
            case EthernetKnob::adaptive_receive: s.adaptive_receive = value != 0; break;
            case EthernetKnob::energy_efficient: s.energy_efficient = value != 0; break;
        }
        return {};
    }
};

}  // namespace taktwerk::apps::test
