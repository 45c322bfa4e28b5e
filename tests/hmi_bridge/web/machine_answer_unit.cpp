// Answers of a machine, or of whoever listens at its socket, as the page's server reads them.
#include <gtest/gtest.h>

#include <string>

#include "hmi_bridge/web/machine_answer.hpp"

namespace taktwerk::hmi::web {
namespace {

// Writing JSON again goes as deep as it does: four megabytes of brackets are deeper than a thread's stack.
TEST(MachineAnswers, OneThatIsDeepIsNone) {
    const auto nested = [](std::size_t levels) {
        return R"({"id":1,"ok":false,"error":)" + std::string(levels, '[') + std::string(levels, ']') + "}";
    };
    const auto flat = read_machine_answer(nested(50));
    ASSERT_TRUE(flat);
    EXPECT_EQ(flat->id, 1);
    EXPECT_FALSE(flat->answer.ok);
    EXPECT_FALSE(read_machine_answer(nested(2'000'000)));
}

}  // namespace
}  // namespace taktwerk::hmi::web
