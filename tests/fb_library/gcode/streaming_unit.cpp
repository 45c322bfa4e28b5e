// A program of any length in the memory that the reader has from the beginning.

#include <gtest/gtest.h>

#include "core/guard/allocation_guard.hpp"
#include "fb_library/gcode/interpreter.hpp"

namespace taktwerk::gcode {
namespace {

/// So many blocks, then the end.
class LongText final : public TextSource {
public:
    explicit LongText(std::uint64_t blocks) : left_(blocks) {}
    TextPiece read(std::span<char> into) noexcept override {
        if (waiting_.empty()) {
            if (ended_) return {TextState::end, 0};
            ended_ = left_ == 0;
            if (ended_) waiting_ = "M2\n";
            else waiting_ = left_-- % 2 == 0 ? "G91 G1 F600 X1.25 Y-3.125 Z0.001\n" : "G3 X-1.25 Y3.125 R20 M101 Q3 (cut)\n";
        }
        const auto bytes = std::min(into.size(), waiting_.size());
        std::copy_n(waiting_.begin(), bytes, into.begin());
        waiting_.remove_prefix(bytes);
        return {TextState::some, bytes};
    }

private:
    std::uint64_t left_;
    std::string_view waiting_;
    bool ended_ = false;
};

TEST(GcodeStreaming, AllocatesNothingOnceItIsMade) {
    LongText text(10'000);
    InterpreterOptions options;
    options.single_block = true;
    Interpreter program(text, options);
    ProgramItem item;
    std::size_t items = 0;
    const NoAllocationScope scope;
    while (program.next(item) == Interpreter::Step::item) ++items;
    EXPECT_EQ(scope.used().total(), 0u) << scope.used().text();
    EXPECT_EQ(program.fault().kind, FaultKind::none);
    EXPECT_EQ(items, 10'000u + 10'000u + 5'000u + 1u) << "a move and a stop each, every second one with M101, and the end";
}

TEST(GcodeStreaming, NorWhenItFails) {
    TextInMemory text("G0 X1\nG41\n");
    Interpreter program(text, {});
    ProgramItem item;
    const NoAllocationScope scope;
    while (program.next(item) == Interpreter::Step::item) {}
    EXPECT_EQ(scope.used().total(), 0u);
    EXPECT_EQ(program.fault().kind, FaultKind::refused_code);
}

TEST(GcodeStreaming, HasItsSizeFromTheBeginning) { EXPECT_LT(sizeof(Interpreter), 24u * 1024u); }

}  // namespace
}  // namespace taktwerk::gcode
