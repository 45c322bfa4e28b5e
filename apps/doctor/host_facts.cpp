#include "apps/doctor/host_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

std::optional<std::int64_t> whole(const HostFiles& files, std::string_view path) {
    const auto value = files.number(path);
    return value ? std::optional<std::int64_t>{static_cast<std::int64_t>(*value)} : std::nullopt;
}

/// `rcu_nocbs=2,3` of the kernel's command line; nothing else tells it.
std::vector<int> cpus_of_parameter(const std::string& line, std::string_view parameter) {
    for (const auto& word : words_of(line)) {
        if (!word.starts_with(parameter) || word.size() <= parameter.size() || word[parameter.size()] != '=') continue;
        return cpu_list(std::string_view(word).substr(parameter.size() + 1));
    }
    return {};
}

/// The word that the kernel puts into brackets: "always [madvise] never".
std::string chosen(const std::string& words) {
    const auto open = words.find('['), close = words.find(']');
    return open == std::string::npos || close == std::string::npos || close < open ? words : words.substr(open + 1, close - open - 1);
}

std::string hypervisor(const HostFiles& files) {
    const auto info = files.text("/proc/cpuinfo").value_or("");
    const auto flags = info.find("\nflags");
    const bool says =
        flags != std::string::npos && info.substr(flags, info.find('\n', flags + 1) - flags).find(" hypervisor") != std::string::npos;
    const auto type = files.text("/sys/hypervisor/type").value_or("");
    if (!says && type.empty()) return {};
    if (!type.empty()) return type;
    const auto vendor = files.text("/sys/class/dmi/id/sys_vendor").value_or("");
    return vendor.empty() ? "a hypervisor" : vendor;
}

KernelFacts kernel_facts(const HostFiles& files) {
    KernelFacts k;
    k.release = files.text("/proc/sys/kernel/osrelease").value_or("");
    // /sys/kernel/realtime came with the patches; kernels that have PREEMPT_RT of their own (6.12) say it in the version alone.
    k.preempt_rt = files.text("/sys/kernel/realtime") == "1" ||
                   files.text("/proc/sys/kernel/version").value_or("").find("PREEMPT_RT") != std::string::npos;
    k.command_line = files.text("/proc/cmdline").value_or("");
    const std::string folder = "/sys/devices/system/clocksource/clocksource0/";
    k.clocksource = files.text(folder + "current_clocksource").value_or("");
    k.clocksources = words_of(files.text(folder + "available_clocksource").value_or(""));
    k.hypervisor = hypervisor(files);
    k.rt_runtime_us = whole(files, "/proc/sys/kernel/sched_rt_runtime_us");
    k.rt_period_us = whole(files, "/proc/sys/kernel/sched_rt_period_us");
    return k;
}

std::vector<SleepState> sleep_states(const HostFiles& files, int cpu) {
    std::vector<SleepState> all;
    const auto folder = fmt::format("/sys/devices/system/cpu/cpu{}/cpuidle", cpu);
    for (const auto& state : files.names(folder)) {
        const auto name = files.text(fmt::format("{}/{}/name", folder, state));
        if (!name) continue;
        all.push_back({*name, files.number(fmt::format("{}/{}/latency", folder, state)).value_or(0),
                       files.number(fmt::format("{}/{}/disable", folder, state)).value_or(0) != 0});
    }
    return all;
}

CpuFacts cpu_facts(const HostFiles& files, const std::string& command_line, std::optional<int> cpu) {
    CpuFacts c;
    const std::string folder = "/sys/devices/system/cpu/";
    c.online = cpu_list(files.text(folder + "online").value_or(""));
    c.isolated = cpu_list(files.text(folder + "isolated").value_or(""));
    c.nohz_full = cpu_list(files.text(folder + "nohz_full").value_or(""));
    c.rcu_nocbs = cpus_of_parameter(command_line, "rcu_nocbs");
    c.smt = files.number(folder + "smt/active").value_or(0) != 0;
    for (const int each : c.online) {
        if (cpu && each != *cpu) continue;
        const auto of = fmt::format("{}cpu{}/cpufreq/", folder, each);
        const auto governor = files.text(of + "scaling_governor");
        if (!governor) continue;
        if (std::find(c.governors.begin(), c.governors.end(), *governor) == c.governors.end()) c.governors.push_back(*governor);
        c.slowest_mhz = files.number(of + "cpuinfo_min_freq").value_or(0) / 1000;
        c.fastest_mhz = files.number(of + "cpuinfo_max_freq").value_or(0) / 1000;
    }
    const int shown = cpu.value_or(c.online.empty() ? 0 : c.online.front());
    c.sleep_states = sleep_states(files, shown);
    for (const int other : cpu_list(files.text(fmt::format("{}cpu{}/topology/thread_siblings_list", folder, shown)).value_or("")))
        if (other != shown) c.siblings.push_back(other);
    return c;
}

MemoryFacts memory_facts(const HostFiles& files) {
    MemoryFacts m;
    const auto info = files.text("/proc/meminfo").value_or("");
    if (const auto at = info.find("SwapTotal:"); at != std::string::npos) m.swap_kb = std::strtod(info.c_str() + at + 10, nullptr);
    m.huge_pages = chosen(files.text("/sys/kernel/mm/transparent_hugepage/enabled").value_or(""));
    m.compacts_locked = whole(files, "/proc/sys/vm/compact_unevictable_allowed");
    m.numa_balancing = whole(files, "/proc/sys/kernel/numa_balancing");
    m.nodes = std::max<std::size_t>(1, cpu_list(files.text("/sys/devices/system/node/online").value_or("0")).size());
    m.receive_buffer_max = whole(files, "/proc/sys/net/core/rmem_max");
    return m;
}

/// The soft limit of a line of /proc/self/limits, which begins with `what`.
std::optional<double> limit(const std::string& limits, std::string_view what) {
    const auto at = limits.find(what);
    if (at == std::string::npos) return std::nullopt;
    const auto rest = words_of(std::string_view(limits).substr(at + what.size(), 40));
    if (rest.empty()) return std::nullopt;
    return rest.front() == "unlimited" ? std::numeric_limits<double>::infinity() : std::strtod(rest.front().c_str(), nullptr);
}

RightsFacts rights_facts(const HostFiles& files) {
    constexpr unsigned ipc_lock = 14, sys_nice = 23;  // capability(7): CAP_IPC_LOCK, CAP_SYS_NICE
    RightsFacts r;
    const auto limits = files.text("/proc/self/limits").value_or("");
    r.realtime_priority = limit(limits, "Max realtime priority");
    r.locked_bytes = limit(limits, "Max locked memory");
    const auto status = files.text("/proc/self/status").value_or("");
    if (const auto at = status.find("CapEff:"); at != std::string::npos) {
        const auto held = std::strtoull(status.c_str() + at + 7, nullptr, 16);
        r.may_schedule = (held >> sys_nice & 1) != 0;
        r.may_lock = (held >> ipc_lock & 1) != 0;
    }
    r.may_hold_latency = files.writable("/dev/cpu_dma_latency");
    return r;
}

std::vector<std::string> running(const HostFiles& files) {
    std::vector<std::string> all;
    for (const auto& process : files.names("/proc"))
        if (!process.empty() && process.find_first_not_of("0123456789") == std::string::npos)
            if (auto name = files.text("/proc/" + process + "/comm"); name && !name->empty()) all.push_back(std::move(*name));
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

}  // namespace

HostFacts host_facts(const HostFiles& files, std::optional<int> cpu) {
    HostFacts facts;
    facts.kernel = kernel_facts(files);
    facts.cpu = cpu_facts(files, facts.kernel.command_line, cpu);
    facts.memory = memory_facts(files);
    facts.rights = rights_facts(files);
    facts.programs = running(files);
    facts.has_group = ("\n" + files.text("/etc/group").value_or("")).find("\ntaktwerk:") != std::string::npos;
    return facts;
}

}  // namespace taktwerk::apps
