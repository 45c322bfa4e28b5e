// Counts each scan into retained variables, and tells it on a page of memory that others have mapped too (told_count.hpp). Memory alone: a scan that
// stores there enters no kernel.

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <limits>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"
#include "tests/apps/retain/told_count.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::apps;

ToldCount* page() {
    const char* name = std::getenv(told_count_variable);
    const int file = name != nullptr ? ::open(name, O_RDWR | O_CLOEXEC) : -1;
    if (file < 0) return nullptr;
    auto* memory = ::mmap(nullptr, sizeof(ToldCount), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file, 0);
    ::close(file);
    return memory != MAP_FAILED ? static_cast<ToldCount*>(memory) : nullptr;
}

class TellingCounter final : public Program {
public:
    void declare(Declaration& d) override {
        told_ = page();
        d.retain("together", together_);
        d.retain("pulses", pulses_);
        d.monitor("count", together_[0]);
        d.task<&TellingCounter::scan>("main");
    }
    void start() override {
        if (told_ == nullptr) return;
        for (std::size_t i = 0; i < counted_together; ++i) told_->found[i] = together_[i];
        told_->found_block = pulses_.CV;
        ++told_->starts;
    }
    void scan(TaskContext& ctx) {
        pulses_.CU = !pulses_.CU;  // it counts edges: each second scan, beginning with the first
        pulses_.PV = std::numeric_limits<std::int64_t>::max();
        pulses_(ctx);
        for (auto& one : together_) ++one;
        if (told_ == nullptr) return;
        const auto count = together_[0];
        told_->since[static_cast<std::size_t>(count) % ToldCount::remembered] = ctx.now.time_since_epoch().count();
        told_->count = count;
    }

private:
    std::array<std::int64_t, counted_together> together_{};
    fb::CTU_LINT pulses_;
    ToldCount* told_ = nullptr;
};

}  // namespace

TAKTWERK_PROGRAM(TellingCounter)
