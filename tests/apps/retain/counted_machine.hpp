#pragma once
// A machine without axes on a simulated bus whose program counts each scan, run by the built command in real time. What it keeps stands in kept().

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "core/time.hpp"
#include "runtime/retain/retain_store.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/apps/retain/told_count.hpp"

namespace taktwerk::apps {

/// Of its variables, as a start would find them.
struct KeptCount {
    bool torn = false;            ///< its variables are not of one scan
    std::int64_t count = 0;       ///< 0: nothing is kept
    std::vector<Error> damage{};  ///< files that cannot be used
    bool lost = false;            ///< none of them can
};

class CountedMachine {
public:
    /// In virtual time one thread does everything in a fixed order: there what is lost is known to the cycle.
    enum class Time : std::uint8_t { real, as_fast_as_it_goes };
    static constexpr Duration every = std::chrono::milliseconds{100}, cycle = std::chrono::milliseconds{2};

    CountedMachine() {
        auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-counted-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data());
        std::ofstream(at("counted.yaml"))
            << "version: 1\nname: counted\ncycle: 2 ms\nstart_mode: automatic\n"
               "bus:\n  interface: simulated\n  slaves:\n    - { name: io, terminal: { inputs: 8, outputs: 8 } }\n"
               "programs:\n  p:\n    library: "
            << TAKTWERK_BINARY_DIR
            << "/tests/telling_counter.so\n    autostart: true\n    tasks: { main: { every: 1 cycles } }\n"
               "retain: { directory: '"
            << kept().string() << "', every: 100 ms }\n"
            << "realtime: { lock_memory: false }\nsimulation: { supervision: relaxed }\n"
               "hmi: { socket: '"
            << at("socket") << "', lcm: { enabled: false } }\n";
        const int file = ::open(at("told").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
        if (file >= 0 && ::ftruncate(file, sizeof(ToldCount)) == 0) {
            auto* memory = ::mmap(nullptr, sizeof(ToldCount), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
            if (memory != MAP_FAILED) told_ = static_cast<ToldCount*>(memory);
        }
        ::close(file);
        ::setenv(told_count_variable, at("told").c_str(), 1);
    }
    ~CountedMachine() {
        run_.reset();
        if (told_ != nullptr) ::munmap(told_, sizeof(ToldCount));
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    CountedMachine(const CountedMachine&) = delete;
    CountedMachine& operator=(const CountedMachine&) = delete;

    [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::filesystem::path kept() const { return folder_ / "kept"; }
    [[nodiscard]] ToldCount& told() { return *told_; }
    [[nodiscard]] Child& process() { return *run_; }

    /// As after a power cut: the computer was off, so nothing stands there of the run before but what is on the disk.
    void switch_on(Time time) {
        std::error_code ignored;
        for (const auto* left : {"socket", "socket.running"}) std::filesystem::remove(at(left), ignored);
        std::vector<std::string> words{taktwerk, "run", at("counted.yaml"), "--simulate", "--retain", kept()};
        if (time == Time::as_fast_as_it_goes) words.emplace_back("--virtual-time");
        run_ = std::make_unique<Child>(std::move(words));
    }
    /// kill -9; what it has said.
    std::string cut_power() {
        run_->signal(SIGKILL);
        (void)run_->wait(std::chrono::seconds{10});
        auto said = run_->text();
        run_.reset();
        return said;
    }
    [[nodiscard]] KeptCount read_kept() const {
        auto loaded = runtime::RetainStore(kept()).load();
        KeptCount out;
        out.damage = std::move(loaded.damage);
        out.lost = loaded.lost;
        std::size_t variables = 0;
        for (const auto& value : loaded.kept.values) {
            if (!value.name.starts_with("p.together")) continue;
            const auto count = static_cast<std::int64_t>(value.bits);
            if (variables++ == 0) out.count = count;
            out.torn = out.torn || count != out.count;
        }
        out.torn = out.torn || (variables != 0 && variables != counted_together);
        return out;
    }

private:
    std::filesystem::path folder_;
    ToldCount* told_ = nullptr;
    std::unique_ptr<Child> run_;
};

}  // namespace taktwerk::apps
