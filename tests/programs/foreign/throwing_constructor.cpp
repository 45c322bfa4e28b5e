// Reads a file in its constructor, and the file is not there.
#include <stdexcept>

#include "programs/api/entry.hpp"

namespace {
class ThrowingConstructor final : public taktwerk::Program {
public:
    ThrowingConstructor() { throw std::runtime_error("recipe.txt: no such file"); }
    void declare(taktwerk::Declaration&) override {}
};
}  // namespace

TAKTWERK_PROGRAM(ThrowingConstructor)
