#include "runtime/run/fault_watch.hpp"

#include "runtime/recording/inbox_record.hpp"

namespace taktwerk::runtime {

namespace {
constexpr Duration between_looks = std::chrono::milliseconds{100};
constexpr Duration first_touches = std::chrono::seconds{1};
}  // namespace

void FaultWatch::look(Instant now) {
    const int thread = thread_.load(std::memory_order_acquire);
    if (thread == 0 || now < next_ || machine_.phase() != MachinePhase::running) return;
    next_ = now + between_looks;
    if (!faults_) faults_.emplace(thread);
    if (!running_since_) running_since_ = now;
    const auto seen = faults_->read();
    if (!seen) return faults_.reset();  // opened anew at the next look
    if (!before_ || now - *running_since_ < first_touches) before_ = *seen;
    else machine_.tell_page_faults({seen->minor - before_->minor, seen->major - before_->major, locked_});
}

}  // namespace taktwerk::runtime
