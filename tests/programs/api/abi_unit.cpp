// The ABI hash notices what would make a program and a runtime misunderstand each other.

#include "programs/api/abi.hpp"

#include <gtest/gtest.h>

namespace taktwerk {
namespace abi_test {

using fb::in;
using fb::out;

// One block in several versions of a library. The name is the type's own, without the namespace.
#define TANK_FUNCTION                                     \
    static constexpr std::string_view summary = "a tank"; \
    void operator()(const axes::MotionContext&) noexcept {}

namespace version_1 {
struct Tank {
    bool Fill = false;
    double Level = 0, Limit = 0;
    static consteval auto pins() { return std::array{in<&Tank::Fill>("", ""), in<&Tank::Limit>("l", ""), out<&Tank::Level>("l", "")}; }
    TANK_FUNCTION
};
}  // namespace version_1
namespace other_words {  // units and texts are for people
struct Tank {
    bool Fill = false;
    double Level = 0, Limit = 0;
    static consteval auto pins() {
        return std::array{in<&Tank::Fill>("", "opens the valve"), in<&Tank::Limit>("m3", ""), out<&Tank::Level>("l", "")};
    }
    TANK_FUNCTION
};
}  // namespace other_words
namespace moved {
struct Tank {
    bool Fill = false;
    double Limit = 0, Level = 0;
    static consteval auto pins() { return std::array{in<&Tank::Fill>("", ""), in<&Tank::Limit>("l", ""), out<&Tank::Level>("l", "")}; }
    TANK_FUNCTION
};
}  // namespace moved
namespace renamed {
struct Tank {
    bool Open = false;
    double Level = 0, Limit = 0;
    static consteval auto pins() { return std::array{in<&Tank::Open>("", ""), in<&Tank::Limit>("l", ""), out<&Tank::Level>("l", "")}; }
    TANK_FUNCTION
};
}  // namespace renamed
namespace retyped {  // of the same size
struct Tank {
    bool Fill = false;
    double Level = 0;
    std::int64_t Limit = 0;
    static consteval auto pins() { return std::array{in<&Tank::Fill>("", ""), in<&Tank::Limit>("l", ""), out<&Tank::Level>("l", "")}; }
    TANK_FUNCTION
};
}  // namespace retyped
namespace added {  // into padding: the size stays
struct Tank {
    bool Fill = false, Drain = false;
    double Level = 0, Limit = 0;
    static consteval auto pins() {
        return std::array{in<&Tank::Fill>("", ""), in<&Tank::Drain>("", ""), in<&Tank::Limit>("l", ""), out<&Tank::Level>("l", "")};
    }
    TANK_FUNCTION
};
}  // namespace added
namespace turned {
struct Tank {
    bool Fill = false;
    double Level = 0, Limit = 0;
    static consteval auto pins() { return std::array{in<&Tank::Fill>("", ""), out<&Tank::Limit>("l", ""), out<&Tank::Level>("l", "")}; }
    TANK_FUNCTION
};
}  // namespace turned
namespace hidden_state {  // no pin, but an instance is larger
struct Tank {
    bool Fill = false;
    double Level = 0, Limit = 0;
    double before = 0;
    static consteval auto pins() { return std::array{in<&Tank::Fill>("", ""), in<&Tank::Limit>("l", ""), out<&Tank::Level>("l", "")}; }
    TANK_FUNCTION
};
}  // namespace hidden_state
#undef TANK_FUNCTION

template <class Block>
constexpr std::uint64_t hash_of = fb::layout_hash(0, fb::block_type<Block>());

constexpr auto reference = hash_of<version_1::Tank>;
static_assert(hash_of<other_words::Tank> == reference);
static_assert(hash_of<moved::Tank> != reference && hash_of<renamed::Tank> != reference && hash_of<retyped::Tank> != reference);
static_assert(hash_of<added::Tank> != reference && hash_of<turned::Tank> != reference && hash_of<hidden_state::Tank> != reference);

TEST(AbiHash, IsAConstantOfTheTreeAndMoreThanTheBlocks) {
    constexpr auto constant = abi_hash();  // of the tree
    EXPECT_NE(constant, fb::block_abi_hash);
    EXPECT_NE(constant, 0u);
}

TEST(AbiHash, DependsOnTheOrderOfBlocks) {
    const auto a = fb::block_type<version_1::Tank>(), b = fb::block_type<moved::Tank>();
    EXPECT_NE(fb::layout_hash(fb::layout_hash(0, a), b), fb::layout_hash(fb::layout_hash(0, b), a));
}

}  // namespace abi_test
}  // namespace taktwerk
