#include "tests/whole_machine/causes.hpp"

#include <array>

namespace taktwerk::whole {

namespace {

using enum Where;
using C = Consequence;

std::span<const Consequence> none() { return {}; }

}  // namespace

std::span<const Consequence> consequences(Trouble trouble) noexcept {
    using enum Trouble;
    switch (trouble) {
        default: return none();
    }
}

std::span<const Consequence> consequences(Deed deed) noexcept {
    using enum Deed;
    switch (deed) {
        default: return none();
    }
}

}  // namespace taktwerk::whole
