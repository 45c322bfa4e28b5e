#include "apps/doctor/findings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace taktwerk::apps {
namespace {

constexpr double lcm_receive_buffer = 2 * 1024 * 1024;
constexpr double one_clock_reading_hpet_us = 1, clock_readings_a_cycle = 30;

using Findings = std::vector<Finding>;

Finding good(std::string code, std::string found) { return {std::move(code), Severity::good, 0, std::move(found), "", "", ""}; }

Finding dear(const Wanted& wanted, std::string code, double cost_us, std::string found, std::string costs, std::string source,
             std::string remedy, std::vector<HostChange> changes = {}, std::string then = {}) {
    return {std::move(code),   severity_of(cost_us, wanted.cycle),
            cost_us,           std::move(found),
            std::move(costs),  std::move(source),
            std::move(remedy), std::move(changes),
            std::move(then)};
}

HostChange file(std::string path, std::string text) { return {HostChange::Kind::file, std::move(path), std::move(text)}; }
HostChange knob(std::string path, std::string value) { return {HostChange::Kind::knob, std::move(path), std::move(value)}; }

void kernel(Findings& out, const HostFacts& facts, const Wanted& wanted) {
    const auto& k = facts.kernel;
    if (k.preempt_rt) out.push_back(good("kernel.preempt_rt", "kernel " + k.release + " is PREEMPT_RT"));
    else
        out.push_back(dear(wanted, "kernel.not_preempt_rt", 1000, "kernel " + k.release + " is not PREEMPT_RT",
                           "some wake-ups come 0.5 to 1 ms late (one in a thousand), the worst ones several ms",
                           "docs/performance.md, \"Over a cable\"", "apt-get install linux-image-rt-amd64 && reboot"));
    if (!k.hypervisor.empty())
        out.push_back(
            dear(wanted, "kernel.virtual_machine", 1000,
                 k.hypervisor == "a hypervisor" ? "this is a virtual machine" : "this is a virtual machine (" + k.hypervisor + ")",
                 "its host takes the CPU away whenever it likes: ms, and nothing in here sees it coming",
                 "docs/performance.md, maxima of its tables", "run machines on a computer of their own; tests and demos are fine here"));
    if (k.rt_runtime_us && k.rt_period_us && *k.rt_runtime_us >= 0 && *k.rt_runtime_us * 10 < *k.rt_period_us * 9)
        out.push_back(dear(wanted, "kernel.rt_share", static_cast<double>(*k.rt_period_us - *k.rt_runtime_us),
                           fmt::format("real-time threads get {} us of {} us", *k.rt_runtime_us, *k.rt_period_us),
                           "once that is used up the cycle stands still for the rest", "sched(7), /proc/sys/kernel/sched_rt_runtime_us",
                           "sysctl kernel.sched_rt_runtime_us=950000",
                           {knob("/proc/sys/kernel/sched_rt_runtime_us", "950000"),
                            file("/etc/sysctl.d/60-taktwerk-rt-share.conf", "kernel.sched_rt_runtime_us = 950000\n")}));
    else if (k.rt_runtime_us == -1)
        out.push_back(dear(wanted, "kernel.rt_unlimited", 0, "real-time threads may take a CPU for ever (sched_rt_runtime_us = -1)",
                           "nothing in a cycle; a task that never returns takes its CPU with everything on it", "sched(7)",
                           "sysctl kernel.sched_rt_runtime_us=950000"));
    else if (k.rt_runtime_us)
        out.push_back(good("kernel.rt_share",
                           fmt::format("real-time threads get {} us of {} us", *k.rt_runtime_us, k.rt_period_us.value_or(1'000'000))));
}

void clock_source(Findings& out, const HostFacts& facts, const Wanted& wanted) {
    const auto& k = facts.kernel;
    if (k.clocksource.empty()) return;
    if (k.clocksource != "hpet" && k.clocksource != "acpi_pm" && k.clocksource != "jiffies") {
        out.push_back(good("clock.source", "clock source " + k.clocksource));
        return;
    }
    const bool has_tsc = std::find(k.clocksources.begin(), k.clocksources.end(), "tsc") != k.clocksources.end();
    out.push_back(dear(wanted, "clock.source", one_clock_reading_hpet_us * clock_readings_a_cycle,
                       "clock source " + k.clocksource + " instead of tsc",
                       "each reading is a system call of about 1 us instead of 25 ns, some 30 in a cycle",
                       "kernel documentation, timers/timekeeping; 30 readings: assumed",
                       has_tsc ? "echo tsc > /sys/devices/system/clocksource/clocksource0/current_clocksource"
                               : "the kernel found tsc unstable: `dmesg | grep -i tsc` says why (often a BIOS that is to be updated)"));
}

void rights(Findings& out, const HostFacts& facts, const Wanted& wanted) {
    const auto& r = facts.rights;
    const auto limits = file("/etc/security/limits.d/60-taktwerk.conf", "@taktwerk - rtprio 95\n@taktwerk - memlock unlimited\n");
    std::vector<HostChange> changes;
    if (facts.has_group) changes.push_back(limits);
    const std::string remedy =
        "run it as the service taktwerk@MACHINE (docs/service.md), or for people of the group taktwerk, from their next login on:\n"
        "printf '@taktwerk - rtprio 95\\n@taktwerk - memlock unlimited\\n' > /etc/security/limits.d/60-taktwerk.conf";
    if (!wanted.of_others && (r.may_schedule || r.realtime_priority.value_or(0) >= 80))
        out.push_back(good("rights.priority", "real-time priority is granted"));
    else
        out.push_back(dear(wanted, "rights.priority", 5000,
                           fmt::format("no real-time priority for this user (rtprio {:.0f})", r.realtime_priority.value_or(0)),
                           "any other program on this computer delays cycles by ms", "sched(7)", remedy, changes));
    if (!wanted.of_others && (r.may_lock || std::isinf(r.locked_bytes.value_or(0)))) {
        out.push_back(good("rights.memory",
                           facts.memory.swap_kb > 0 ? "memory may be locked: swap does not touch the machine" : "memory may be locked"));
    } else {
        out.push_back(
            dear(wanted, "rights.memory", facts.memory.swap_kb > 0 ? 10'000 : 250,
                 fmt::format("memory may not be locked (memlock {:.0f} kB){}", r.locked_bytes.value_or(0) / 1024,
                             facts.memory.swap_kb > 0 ? fmt::format(", and there are {:.0f} MB of swap", facts.memory.swap_kb / 1024) : ""),
                 facts.memory.swap_kb > 0 ? "a page that was swapped out comes back from the disk: 10 ms"
                                          : "program code that was dropped is read from the disk again: 0.25 ms of an SSD, ms of others",
                 "mlockall(2); times of disks: assumed", remedy, changes));
    }
}

void sleep_states(Findings& out, const HostFacts& facts, const Wanted& wanted) {
    const SleepState* deepest = nullptr;
    for (const auto& state : facts.cpu.sleep_states)
        if (!state.disabled && (deepest == nullptr || state.exit_us > deepest->exit_us)) deepest = &state;
    if (deepest == nullptr || deepest->exit_us < 1) {
        out.push_back(
            good("cpu.sleep", deepest == nullptr ? "the kernel knows no sleep states" : "no sleep state that takes long to leave"));
        return;
    }
    if (facts.rights.may_hold_latency && !wanted.of_others) {
        out.push_back(good("cpu.sleep", fmt::format("deepest sleep state {} ({:.0f} us): a running machine keeps the CPUs out of it",
                                                    deepest->name, deepest->exit_us)));
        return;
    }
    std::vector<HostChange> changes;
    const std::string rule = "KERNEL==\"cpu_dma_latency\", GROUP=\"taktwerk\", MODE=\"0660\"";
    if (facts.has_group) changes.push_back(file("/etc/udev/rules.d/60-taktwerk-latency.rules", rule + "\n"));
    out.push_back(dear(wanted, "cpu.sleep", deepest->exit_us,
                       fmt::format("sleep state {} takes {:.0f} us to leave, and this user may not keep the CPUs out of it", deepest->name,
                                   deepest->exit_us),
                       fmt::format("each wake-up comes up to {:.0f} us late", deepest->exit_us),
                       "the kernel's own figure: cpuidle/state*/latency",
                       fmt::format("echo '{}' > /etc/udev/rules.d/60-taktwerk-latency.rules\n"
                                   "udevadm control --reload && udevadm trigger /dev/cpu_dma_latency",
                                   rule),
                       changes, "udevadm control --reload && udevadm trigger /dev/cpu_dma_latency"));
}

void governor(Findings& out, const HostFacts& facts, const Wanted& wanted) {
    const auto& c = facts.cpu;
    if (c.governors.empty()) return;
    if (c.governors == std::vector<std::string>{"performance"}) {
        out.push_back(good("cpu.governor", "frequency governor performance"));
        return;
    }
    const double slower = c.slowest_mhz > 0 && c.fastest_mhz > c.slowest_mhz ? c.fastest_mhz / c.slowest_mhz : 2;
    std::vector<HostChange> changes;
    for (const int cpu : c.online)
        if (wanted.cpu < 0 || cpu == wanted.cpu)
            changes.push_back(knob(fmt::format("/sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor", cpu), "performance"));
    const auto which = wanted.cpu < 0 ? std::string("*") : std::to_string(wanted.cpu);
    changes.push_back(file("/etc/tmpfiles.d/taktwerk-governor.conf",
                           fmt::format("w /sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor - - - - performance\n", which)));
    out.push_back(
        dear(wanted, "cpu.governor", to_seconds(wanted.computing) * 1e6 * (slower - 1),
             fmt::format("frequency governor {} ({:.0f} to {:.0f} MHz)", fmt::join(c.governors, ", "), c.slowest_mhz, c.fastest_mhz),
             fmt::format("a cycle that found the CPU resting computes up to {:.1f} times as long", slower),
             "kernel documentation, admin-guide/pm/cpufreq; the frequencies are this CPU's",
             fmt::format("echo performance | tee /sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor", which), changes));
}

void isolation(Findings& out, const HostFacts& facts, const Wanted& wanted) {
    const auto& c = facts.cpu;
    const int cpu = wanted.cpu >= 0 ? wanted.cpu : !c.isolated.empty() ? c.isolated.back() : c.online.empty() ? 0 : c.online.back();
    const auto has = [&](const std::vector<int>& list) { return std::find(list.begin(), list.end(), cpu) != list.end(); };
    const bool isolated = has(c.isolated), quiet = has(c.nohz_full), callbacks_away = has(c.rcu_nocbs) || quiet;
    if (isolated && quiet && callbacks_away)
        out.push_back(good("cpu.isolation", fmt::format("CPU {} is isolated, without tick and callbacks", cpu)));
    else if (c.online.size() < 2)
        out.push_back(dear(wanted, "cpu.one", 100, "there is one CPU only", "everything else on this computer shares it with the cycle",
                           "assumed", "a computer with two cores or more"));
    else
        out.push_back(dear(
            wanted, "cpu.isolation", isolated ? 10 : 50,
            isolated ? fmt::format("CPU {} is isolated, but the kernel's {} come there", cpu, quiet ? "callbacks" : "tick and callbacks")
                     : fmt::format("no CPU is the cycle's alone (isolcpus does not name CPU {})", cpu),
            isolated ? "the tick of the scheduler takes some us, again and again"
                     : "caches are shared with others, and what they do in the kernel delays the cycle by some 50 us",
            "kernel documentation, admin-guide/kernel-parameters; the figures: assumed",
            fmt::format("in /etc/default/grub: GRUB_CMDLINE_LINUX=\"isolcpus={0} nohz_full={0} rcu_nocbs={0}\"\n"
                        "update-grub && reboot; in the machine file: realtime: {{cpus: [{0}]}}",
                        cpu)));
    if (c.smt && !c.siblings.empty())
        out.push_back(dear(wanted, "cpu.smt", to_seconds(wanted.computing) * 1e6,
                           fmt::format("CPU {} shares its core with CPU {}", cpu, fmt::join(c.siblings, ", ")),
                           "while that one works, computing takes up to twice as long", "assumed",
                           "echo off > /sys/devices/system/cpu/smt/control"));
    if (std::find(facts.programs.begin(), facts.programs.end(), "irqbalance") != facts.programs.end())
        out.push_back(dear(wanted, "cpu.irqbalance", 20, "irqbalance runs", "it moves interrupts onto the cycle's CPU whenever it likes",
                           "irqbalance(1); the figure: assumed", "systemctl disable --now irqbalance"));
}

void memory(Findings& out, const HostFacts& facts, const Wanted& wanted) {
    const auto& m = facts.memory;
    if (m.huge_pages == "always")
        out.push_back(
            dear(wanted, "memory.huge_pages", 100, "transparent huge pages are made of everybody's memory",
                 "khugepaged takes pages of the machine away to put them together: the cycle faults and waits for it",
                 "kernel documentation, admin-guide/mm/transhuge; the figure: assumed",
                 "echo madvise > /sys/kernel/mm/transparent_hugepage/enabled",
                 {knob("/sys/kernel/mm/transparent_hugepage/enabled", "madvise"),
                  file("/etc/tmpfiles.d/taktwerk-huge-pages.conf", "w /sys/kernel/mm/transparent_hugepage/enabled - - - - madvise\n")}));
    else if (!m.huge_pages.empty()) out.push_back(good("memory.huge_pages", "transparent huge pages: " + m.huge_pages));
    if (m.compacts_locked.value_or(0) == 1)
        out.push_back(dear(wanted, "memory.compaction", 50, "the kernel moves locked pages when it wants large free pieces",
                           "a page under way is a page fault of the cycle",
                           "kernel documentation, admin-guide/sysctl/vm (PREEMPT_RT has it off); the figure: assumed",
                           "sysctl vm.compact_unevictable_allowed=0",
                           {knob("/proc/sys/vm/compact_unevictable_allowed", "0"),
                            file("/etc/sysctl.d/60-taktwerk-compaction.conf", "vm.compact_unevictable_allowed = 0\n")}));
    else if (m.compacts_locked) out.push_back(good("memory.compaction", "locked pages stay where they are"));
    if (m.nodes > 1 && m.numa_balancing.value_or(0) != 0)
        out.push_back(dear(
            wanted, "memory.numa", 50, fmt::format("the kernel moves pages between {} memory nodes", m.nodes),
            "it takes pages away to see who wants them: page faults of the cycle",
            "kernel documentation, admin-guide/sysctl/kernel; the figure: assumed", "sysctl kernel.numa_balancing=0",
            {knob("/proc/sys/kernel/numa_balancing", "0"), file("/etc/sysctl.d/60-taktwerk-numa.conf", "kernel.numa_balancing = 0\n")}));
    if (m.receive_buffer_max && static_cast<double>(*m.receive_buffer_max) < lcm_receive_buffer)
        out.push_back(dear(wanted, "network.receive_buffer", 0, fmt::format("net.core.rmem_max is {} bytes", *m.receive_buffer_max),
                           "nothing in a cycle; HMIs over LCM lose messages of a burst (half of 40,000 were)",
                           "LCM's documentation asks for 2 MB", "sysctl net.core.rmem_max=2097152",
                           {knob("/proc/sys/net/core/rmem_max", "2097152"),
                            file("/etc/sysctl.d/60-taktwerk-receive-buffer.conf", "net.core.rmem_max = 2097152\n")}));
    else if (m.receive_buffer_max) out.push_back(good("network.receive_buffer", "receive buffers are large enough for LCM"));
}

}  // namespace

std::vector<Finding> host_findings(const HostFacts& facts, const Wanted& wanted) {
    Findings all;
    kernel(all, facts, wanted);
    clock_source(all, facts, wanted);
    rights(all, facts, wanted);
    sleep_states(all, facts, wanted);
    governor(all, facts, wanted);
    isolation(all, facts, wanted);
    memory(all, facts, wanted);
    return all;
}

}  // namespace taktwerk::apps
