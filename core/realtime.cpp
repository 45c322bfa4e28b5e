#include "core/realtime.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace taktwerk {
namespace {

Error refusal(std::string code, std::string subject, int number, std::string remedy) {
    return Error{std::move(code), std::move(subject), fmt::format("refused by the kernel: {}", std::strerror(number)), std::move(remedy)};
}

void note(RealtimeReport& report, std::string what, const Result<void>& result, std::string consequence) {
    report.items.push_back(realtime_item(std::move(what), result, std::move(consequence)));
}

/// Its own frame is the memory to touch; one write a page is enough.
[[gnu::noinline]] void touch_stack(std::size_t bytes) {
    constexpr std::size_t page = 4096;
    auto* memory = static_cast<volatile char*>(__builtin_alloca(bytes));
    for (std::size_t i = 0; i < bytes; i += page) memory[i] = 0;
}

}  // namespace

RealtimeItem realtime_item(std::string what, const Result<void>& result, std::string consequence) {
    RealtimeItem item;
    item.what = std::move(what);
    item.granted = result.ok();
    if (!item.granted) {
        item.reason = result.error().remedy.empty() ? result.error().what : result.error().what + ". " + result.error().remedy;
        item.consequence = std::move(consequence);
    }
    return item;
}

bool RealtimeReport::all_granted() const noexcept {
    return std::all_of(items.begin(), items.end(), [](const RealtimeItem& item) { return item.granted; });
}

std::string RealtimeReport::text() const {
    std::string out;
    for (const auto& item : items) {
        if (item.granted) out += fmt::format("granted: {}\n", item.what);
        else out += fmt::format("refused: {} ({}): {}\n", item.what, item.reason, item.consequence);
    }
    return out;
}

Result<CpuLatencyHold> CpuLatencyHold::acquire(Duration worst_wake_up, const std::string& device) {
    const int file = ::open(device.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) return refusal("realtime.cpu_latency", device, errno, "It needs root, or write permission for this file");
    const auto microseconds = static_cast<std::int32_t>(std::chrono::duration_cast<std::chrono::microseconds>(worst_wake_up).count());
    if (::write(file, &microseconds, sizeof microseconds) != static_cast<ssize_t>(sizeof microseconds)) {
        const int number = errno;
        ::close(file);
        return refusal("realtime.cpu_latency", device, number, "");
    }
    return CpuLatencyHold{file};
}

CpuLatencyHold::~CpuLatencyHold() {
    if (file_ >= 0) ::close(file_);
}

CpuLatencyHold::CpuLatencyHold(CpuLatencyHold&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

CpuLatencyHold& CpuLatencyHold::operator=(CpuLatencyHold&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
}

Result<void> set_fifo_priority(int priority) {
    if (priority < 1 || priority > 99)
        return Error{"realtime.priority", "", fmt::format("{} is no SCHED_FIFO priority", priority),
                     "Choose 1..99; 80 is usual for the cycle"};
    sched_param parameters{};
    parameters.sched_priority = priority;
    // RESET_ON_FORK: threads that libraries start from here are ordinary ones.
    if (::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters) != 0)
        return refusal("realtime.priority", "", errno,
                       "Grant CAP_SYS_NICE or set `rtprio` in /etc/security/limits.conf (systemd: LimitRTPRIO=95)");
    return {};
}

bool has_fifo_priority() noexcept { return (::sched_getscheduler(0) & ~SCHED_RESET_ON_FORK) == SCHED_FIFO; }

int this_thread_number() noexcept { return static_cast<int>(::gettid()); }

Result<void> take_priority(int thread) {
    const sched_param parameters{};
    // The flag stays: only a privileged process may clear it.
    if (::sched_setscheduler(thread, SCHED_OTHER | SCHED_RESET_ON_FORK, &parameters) != 0)
        return refusal("realtime.priority", fmt::format("thread {}", thread), errno, "");
    return {};
}

Result<void> lock_memory() {
    if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
        return refusal("realtime.lock_memory", "", errno, "Grant CAP_IPC_LOCK or set `memlock unlimited` in /etc/security/limits.conf");
    // Memory once faulted in stays: no trimming of the heap, no big blocks by mmap that are unmapped when freed.
    ::mallopt(M_TRIM_THRESHOLD, -1);
    ::mallopt(M_MMAP_MAX, 0);
    return {};
}

Result<void> pin_to_cpus(const std::vector<int>& cpus) {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (const int cpu : cpus) {
        if (cpu < 0 || cpu >= CPU_SETSIZE) return Error{"realtime.cpus", fmt::format("CPU {}", cpu), "there is no such CPU", "See `lscpu`"};
        CPU_SET(cpu, &set);
    }
    if (::sched_setaffinity(0, sizeof set, &set) != 0)
        return refusal("realtime.cpus", fmt::format("CPU {}", fmt::join(cpus, ", ")), errno,
                       "See `lscpu` for the CPUs there are, and the service's CPUAffinity=");
    return {};
}

Result<void> set_timer_slack(Duration slack) {
    if (::prctl(PR_SET_TIMERSLACK, std::max<unsigned long>(1, static_cast<unsigned long>(std::max<std::int64_t>(slack.count(), 0)))) != 0)
        return refusal("realtime.timer_slack", "", errno, "");
    return {};
}

Result<void> prefault_stack(std::size_t bytes) {
    constexpr std::size_t spare = 64 * 1024;
    pthread_attr_t attributes;
    if (const int number = ::pthread_getattr_np(::pthread_self(), &attributes); number != 0)
        return refusal("realtime.stack", "", number, "");
    void* lowest = nullptr;
    std::size_t size = 0;
    ::pthread_attr_getstack(&attributes, &lowest, &size);
    ::pthread_attr_destroy(&attributes);
    const auto left = static_cast<std::size_t>(static_cast<char*>(__builtin_frame_address(0)) - static_cast<char*>(lowest));
    if (left < bytes + spare)
        return Error{"realtime.stack", "",
                     fmt::format("the thread has {} KB of stack left, {} KB were to be touched", left / 1024, bytes / 1024),
                     "Ask for less, or start the thread with a larger stack"};
    touch_stack(bytes);
    return {};
}

bool kernel_is_preempt_rt() {
    utsname kernel{};
    if (::uname(&kernel) == 0 && std::strstr(kernel.version, "PREEMPT_RT") != nullptr) return true;
    std::FILE* file = std::fopen("/sys/kernel/realtime", "re");
    if (file == nullptr) return false;
    const bool yes = std::fgetc(file) == '1';
    std::fclose(file);
    return yes;
}

RealtimeReport prepare_process(const RealtimeRequest& request, CpuLatencyHold& hold) {
    RealtimeReport report;
    note(report, "PREEMPT_RT kernel",
         kernel_is_preempt_rt() ? Result<void>{}
                                : Error{"realtime.kernel", "", "this kernel is not PREEMPT_RT", "Install linux-image-rt-amd64"},
         "single cycles may start late by several 100 us to milliseconds; fit for tests and cycles from about 10 ms");
    if (request.lock_memory)
        note(report, std::string(memory_locked), lock_memory(),
             "a page that was swapped out or never touched delays a cycle by 10 us to milliseconds");
    if (request.hold_cpu_latency) {
        auto acquired = CpuLatencyHold::acquire();
        note(report, "CPU kept out of deep sleep", acquired.ok() ? Result<void>{} : acquired.error(),
             "waking from a deep sleep state adds up to some 100 us to a cycle's start");
        if (acquired.ok()) hold = std::move(acquired).value();
    }
    return report;
}

RealtimeReport prepare_cycle_thread(const RealtimeRequest& request) {
    RealtimeReport report;
    if (request.prefault_stack > 0)
        note(report, fmt::format("{} KB of stack touched", request.prefault_stack / 1024), prefault_stack(request.prefault_stack),
             "the first cycles that go deeper are delayed by page faults");
    if (!request.cpus.empty())
        note(report, fmt::format("pinned to CPU {}", fmt::join(request.cpus, ", ")), pin_to_cpus(request.cpus),
             "the scheduler moves the cycle between CPUs: cold caches and other load delay it");
    note(report, "timer slack 1 ns", set_timer_slack(Duration{1}), "without a real-time priority, cycles start up to 50 us late");
    if (request.priority)
        note(report, fmt::format("SCHED_FIFO priority {}", *request.priority), set_fifo_priority(*request.priority),
             "any other program on this computer can delay cycles by milliseconds; cycles are missed under load");
    return report;
}

}  // namespace taktwerk
