// Calls a function that nobody defines; linked without -z defs, as by hand.
#include "programs/api/entry.hpp"

extern "C" void taktwerk_nowhere();

namespace {
class Unresolved final : public taktwerk::Program {
    void declare(taktwerk::Declaration& d) override { d.task<&Unresolved::scan>("main"); }
    void scan(taktwerk::TaskContext&) { taktwerk_nowhere(); }
};
}  // namespace

TAKTWERK_PROGRAM(Unresolved)
