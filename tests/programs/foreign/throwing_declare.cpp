// declare() throws, and not even a std::exception.
#include "programs/api/entry.hpp"

namespace {
class ThrowingDeclare final : public taktwerk::Program {
    void declare(taktwerk::Declaration&) override { throw 7; }
};
}  // namespace

TAKTWERK_PROGRAM(ThrowingDeclare)
