// Nothing wrong with it: shows that the others are refused for their defect.
#include "programs/api/entry.hpp"

namespace {
class Good final : public taktwerk::Program {
    void declare(taktwerk::Declaration& d) override { d.task<&Good::scan>("main"); }
    void scan(taktwerk::TaskContext&) noexcept {}
};
}  // namespace

TAKTWERK_PROGRAM(Good)
