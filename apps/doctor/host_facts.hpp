#pragma once
// What of this computer decides how punctually a cycle wakes, as its kernel states it. Facts only: what they mean is for findings.hpp. What could
// not be read stays nothing or empty. Not real-time.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/doctor/host_files.hpp"

namespace taktwerk::apps {

struct KernelFacts {
    std::string release;       ///< "6.1.0-28-rt-amd64"
    bool preempt_rt = false;   ///< its version line says so, or /sys/kernel/realtime does
    std::string command_line;  ///< it was started with
    std::string clocksource;   ///< "tsc"
    std::vector<std::string> clocksources;
    std::string hypervisor;  ///< what this virtual machine runs on, "a hypervisor" where nobody names it; empty: a real computer
    std::optional<std::int64_t> rt_runtime_us, rt_period_us;  ///< share of a CPU that real-time threads may have; -1: all of it
};

struct SleepState {
    std::string name;  ///< "C6"
    double exit_us = 0;
    bool disabled = false;
};

struct CpuFacts {
    std::vector<int> online, isolated, nohz_full, rcu_nocbs;
    std::vector<std::string> governors;  ///< of the CPUs asked for, each once; empty: the kernel sets no frequency here
    double slowest_mhz = 0, fastest_mhz = 0;
    std::vector<SleepState> sleep_states;  ///< of the CPU asked for, else of the first
    bool smt = false;                      ///< two threads share a core
    std::vector<int> siblings;             ///< of the CPU asked for, without itself
};

struct MemoryFacts {
    double swap_kb = 0;
    std::string huge_pages;                       ///< "always", "madvise", "never"; empty: the kernel has none
    std::optional<std::int64_t> compacts_locked;  ///< vm.compact_unevictable_allowed
    std::optional<std::int64_t> numa_balancing;
    std::size_t nodes = 1;
    std::optional<std::int64_t> receive_buffer_max;  ///< net.core.rmem_max, bytes
};

/// Of this process, and so of a machine that the same user starts.
struct RightsFacts {
    std::optional<double> realtime_priority;  ///< RLIMIT_RTPRIO
    std::optional<double> locked_bytes;       ///< RLIMIT_MEMLOCK; infinity: any amount
    bool may_schedule = false;                ///< CAP_SYS_NICE
    bool may_lock = false;                    ///< CAP_IPC_LOCK
    bool may_hold_latency = false;            ///< /dev/cpu_dma_latency can be opened
};

struct HostFacts {
    KernelFacts kernel;
    CpuFacts cpu;
    MemoryFacts memory;
    RightsFacts rights;
    std::vector<std::string> programs;  ///< names of what runs, each once, sorted
    bool has_group = false;             ///< the group `taktwerk` of the package
};

/// `cpu`: the one that the cycle shall have; nothing: any.
[[nodiscard]] HostFacts host_facts(const HostFiles& files, std::optional<int> cpu);

}  // namespace taktwerk::apps
