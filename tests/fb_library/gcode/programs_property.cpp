// Programs of drawn moves, written as text in as many manners as the language has, come back as the moves that were drawn; and whatever bytes come, the reader ends, says where, and
// does no more than so many reads a byte.

#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fb_library/gcode/program_summary.hpp"
#include "tests/fb_library/gcode/read_program.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::gcode {
namespace {

using std::numbers::pi;

/// Writes moves and keeps what they have to come back as.
class Writer {
public:
    explicit Writer(std::uint32_t seed) : random_(seed) {}

    std::string text;
    std::vector<Move> moves;

    void program(int blocks) {
        if (chance(2)) line("%"), percent_ = true;
        for (int i = 0; i < blocks; ++i) block();
        if (percent_ && chance(2)) text += "%\n";
        else line("M30");
    }

private:
    bool chance(unsigned of) { return random_() % of == 0; }
    double draw(double most) { return std::round((std::uniform_real_distribution(-most, most)(random_)) * 1000) / 1000; }

    void line(const std::string& words) { text += words + (chance(3) ? "\r\n" : "\n"); }

    std::string letter(char c) { return std::string(1, chance(3) ? static_cast<char>(c + 32) : c) + (chance(4) ? " " : ""); }
    /// In the units in force; nine decimals say an inch to 3e-8 mm.
    std::string number(double mm) {
        auto digits = fmt::format("{:.9f}", mm / unit_);
        while (digits.back() == '0') digits.pop_back();
        if (digits.back() == '.' && chance(2)) digits.pop_back();
        if (digits == "-0" || digits == "-0.") digits = "0";
        if (digits.starts_with("0.") && digits.size() > 2 && chance(2)) digits.erase(0, 1);
        return digits;
    }
    std::string word(char c, double mm) { return letter(c) + number(mm); }
    std::string code(const char* word) { return letter(word[0]) + (word + 1); }

    void block() {
        if (chance(6)) line(chance(2) ? "" : "( a comment; with G0 X999 in it )");
        if (chance(8)) unit_ = chance(2) ? 25.4 : 1, line(unit_ == 1 ? "G21" : "G20"), feed_ = 0;
        if (chance(8)) relative_ = !relative_, line(relative_ ? "G91" : "G90");
        if (chance(8)) {
            plane_ = random_() % 3;
            constexpr const char* words[] = {"G19", "G18", "G17"};
            line(words[plane_]);
        }
        chance(3) ? arc() : straight();
    }

    void put(std::vector<std::string> words, const Move& move) {
        std::shuffle(words.begin(), words.end(), random_);
        std::string block = chance(5) ? fmt::format("N{} ", moves.size() * 10) : "";
        for (const auto& each : words) block += each + (chance(3) ? "" : " ");
        if (chance(9)) block += "; as before";
        line(block);
        moves.push_back(move);
        position_ = move.to;
    }

    void with_mode(std::vector<std::string>& words, const char* mode) {
        if (mode_ != mode || chance(4)) words.push_back(code(mode));
        mode_ = mode;
    }
    void with_feed(std::vector<std::string>& words, Move& move) {
        if (feed_ == 0 || chance(4)) {
            feed_ = unit_ * std::round(10 + 100 * std::fabs(draw(1)));
            words.push_back(word('F', feed_));
        }
        move.feed = {Feed::Kind::mm_per_s, feed_ / 60};
    }
    void with_target(std::vector<std::string>& words, const Move& move, bool all) {
        for (std::size_t axis = 0; axis < linear_axes; ++axis)
            if (all || move.to[axis] != position_[axis] || chance(5))
                words.push_back(word(axis_letters[axis], move.to[axis] - (relative_ ? position_[axis] : 0)));
    }

    void straight() {
        Move move;
        move.from = move.to = position_;
        for (std::size_t axis = 0; axis < linear_axes; ++axis)
            if (axis == moves.size() % 3 || chance(2)) move.to[axis] = draw(500);
        if (move.to == move.from) return;
        const bool rapid = chance(3);
        std::vector<std::string> words;
        with_mode(words, rapid ? "G0" : "G1");
        if (!rapid) with_feed(words, move);
        with_target(words, move, false);
        put(std::move(words), move);
    }

    void arc() {
        constexpr char offsets[] = "IJK";
        const std::size_t normal = plane_, first = (plane_ + 1) % 3, second = (plane_ + 2) % 3;
        const double radius = 1 + std::fabs(draw(100)), from = draw(pi), sweep = 0.1 + std::fabs(draw(5.5));
        const bool clockwise = chance(2), by_radius = chance(2) && std::fabs(sweep - pi) > 0.2;
        Move move;
        move.kind = Move::Kind::arc, move.normal = static_cast<std::uint8_t>(normal);
        move.from = move.to = position_;
        move.centre[first] = position_[first] - radius * std::cos(from), move.centre[second] = position_[second] - radius * std::sin(from);
        move.centre[normal] = position_[normal];
        move.angle = clockwise ? -sweep : sweep;
        move.to[first] = move.centre[first] + radius * std::cos(from + move.angle);
        move.to[second] = move.centre[second] + radius * std::sin(from + move.angle);
        if (chance(3)) move.to[normal] = draw(50);
        std::vector<std::string> words;
        with_mode(words, clockwise ? "G2" : "G3");
        with_feed(words, move);
        with_target(words, move, true);
        if (by_radius) words.push_back(word('R', sweep > pi ? -radius : radius));
        else {
            words.push_back(word(offsets[first], move.centre[first] - position_[first]));
            words.push_back(word(offsets[second], move.centre[second] - position_[second]));
        }
        if (chance(4)) {
            const int turns = 1 + static_cast<int>(random_() % 4);
            words.push_back(fmt::format("P{}", turns));
            move.angle += (clockwise ? -2 : 2) * pi * (turns - 1);
        }
        put(std::move(words), move);
    }

    std::mt19937 random_;
    AxisValues position_{};
    double unit_ = 1, feed_ = 0;
    bool relative_ = false, percent_ = false;
    std::size_t plane_ = 2;
    std::string mode_;
};

TEST(GcodeProgram, WrittenAndReadAgainHasTheSameMoves) {
    constexpr double close = 1e-5;  // mm: nine decimals of an inch, summed up over relative moves, and what R makes of them
    for (std::size_t seed = 0; seed < property_cases(300); ++seed) {
        Writer written(static_cast<std::uint32_t>(seed));
        written.program(60);
        const auto read = read_program(written.text, {}, 1 + seed % 97);
        ASSERT_EQ(read.wrong(), "") << "seed " << seed << "\n" << fault_error(read.fault, "").text() << "\n" << written.text;
        const auto moves = read.moves();
        ASSERT_EQ(moves.size(), written.moves.size()) << "seed " << seed;
        for (std::size_t i = 0; i < moves.size(); ++i) {
            const auto &is = moves[i], &wanted = written.moves[i];
            ASSERT_EQ(is.kind, wanted.kind) << "seed " << seed << " move " << i;
            ASSERT_EQ(is.feed.kind, wanted.feed.kind);
            ASSERT_NEAR(is.feed.value, wanted.feed.value, 1e-6) << "seed " << seed << " move " << i;
            for (std::size_t axis = 0; axis < axis_count; ++axis) {
                ASSERT_NEAR(is.to[axis], wanted.to[axis], close) << "seed " << seed << " move " << i;
                if (i > 0) {
                    ASSERT_EQ(is.from[axis], moves[i - 1].to[axis]) << "no gap";
                }
            }
            if (is.kind != Move::Kind::arc) continue;
            ASSERT_EQ(is.normal, wanted.normal);
            ASSERT_NEAR(is.angle, wanted.angle, 1e-4) << "seed " << seed << " move " << i;
            for (std::size_t axis = 0; axis < linear_axes; ++axis)
                ASSERT_NEAR(is.centre[axis], wanted.centre[axis], 1e-3) << "seed " << seed << " move " << i;
        }
    }
}

// Arcs are true circles that end where they say, and the extents of a program are those of its points, taken densely.
TEST(GcodeProgram, ArcsAreCirclesAndExtentsHoldAllTheirPoints) {
    for (std::size_t seed = 0; seed < property_cases(60); ++seed) {
        Writer written(static_cast<std::uint32_t>(seed) + 3'000'000);
        written.program(20);
        ProgramSummary summary;
        const auto moves = read_program(written.text).moves();
        std::array<double, linear_axes> least{}, most{};
        double length = 0;
        for (const auto& item : read_program(written.text).items) summary.add(item);
        for (const auto& move : moves) {
            const auto first = (move.normal + 1u) % 3, second = (move.normal + 2u) % 3;
            const double radius = std::hypot(move.from[first] - move.centre[first], move.from[second] - move.centre[second]);
            constexpr int points = 4000;
            AxisValues before = move.from;
            for (int i = 0; i <= points; ++i) {
                const auto at = point_of(move, i == points ? 1 - 1e-13 : static_cast<double>(i) / points);
                if (move.kind == Move::Kind::arc) {
                    ASSERT_NEAR(std::hypot(at[first] - move.centre[first], at[second] - move.centre[second]), radius, 1e-9);
                }
                for (std::size_t axis = 0; axis < linear_axes; ++axis)
                    least[axis] = std::min(least[axis], at[axis]), most[axis] = std::max(most[axis], at[axis]);
                length += std::hypot(at[0] - before[0], at[1] - before[1], at[2] - before[2]);
                before = at;
            }
            for (std::size_t axis = 0; axis < linear_axes; ++axis)
                ASSERT_NEAR(before[axis], move.to[axis], 1e-7) << "it ends where it says";
        }
        ASSERT_NEAR(summary.rapids().length_mm + summary.lines().length_mm + summary.arcs().length_mm, length, 1e-4 * length);
        for (std::size_t axis = 0; axis < linear_axes; ++axis) {
            ASSERT_NEAR(summary.extents()[axis].least, least[axis], 1e-3) << "seed " << seed;
            ASSERT_NEAR(summary.extents()[axis].most, most[axis], 1e-3) << "seed " << seed;
        }
    }
}

/// Counts how often it is asked.
class CountedText final : public TextSource {
public:
    explicit CountedText(std::string_view text) : text_(text, 64) {}
    TextPiece read(std::span<char> into) noexcept override {
        ++reads;
        return text_.read(into);
    }
    std::size_t reads = 0;

private:
    TextInMemory text_;
};

std::string garbage(std::mt19937& random, std::size_t bytes) {
    constexpr std::string_view telling = "GGGMXYZIJKRFSTPQLHNabco0123456789012345678901234567890..--++  \n\n\n%/();,#[]\r\t";
    std::string text(bytes, ' ');
    const bool any = random() % 4 == 0;
    for (auto& c : text) c = any ? static_cast<char>(random()) : telling[random() % telling.size()];
    return text;
}

TEST(GcodeProgram, GarbageEndsWithAFaultOrAnEndAfterBoundedWork) {
    std::mt19937 random(11);
    std::size_t faults = 0;
    for (std::size_t i = 0; i < property_cases(20'000); ++i) {
        const auto text = garbage(random, random() % 400);
        CountedText source(text);
        InterpreterOptions options;
        options.rotary = random() % 2 == 0 ? InterpreterOptions::Rotary::offered : InterpreterOptions::Rotary::refused;
        options.block_delete = random() % 2 == 0, options.single_block = random() % 2 == 0,
        options.start_line = 1 + static_cast<std::uint32_t>(random() % 3);
        Interpreter program(source, options);
        ProgramItem item;
        std::size_t items = 0;
        auto step = program.next(item);
        for (; step == Interpreter::Step::item; step = program.next(item)) {
            ASSERT_LT(++items, text.size() + 2) << "at most an item a byte, and the end";
            for (const double value : item.move.to) ASSERT_TRUE(std::isfinite(value));
            ASSERT_TRUE(std::isfinite(item.move.angle));
        }
        ASSERT_LE(source.reads, text.size() / 64 + 2);
        if (step == Interpreter::Step::end) continue;
        ++faults;
        ASSERT_EQ(step, Interpreter::Step::fault);
        const auto error = fault_error(program.fault(), "x");
        ASSERT_FALSE(error.what.empty());
        for (const char c : error.text()) ASSERT_GE(static_cast<unsigned char>(c), 0x20u) << "nothing of the file as it is";
    }
    EXPECT_GT(faults, property_cases(20'000) / 2) << "most of it is no program";
}

// One word changed in a program that is right: the same moves up to that block, then others, or a fault that names it.
TEST(GcodeProgram, AChangedByteChangesNothingBeforeItsLine) {
    for (std::size_t seed = 0; seed < property_cases(300); ++seed) {
        Writer written(static_cast<std::uint32_t>(seed) + 1'000'000);
        written.program(20);
        std::mt19937 random(static_cast<std::uint32_t>(seed));
        auto text = written.text;
        const auto at = random() % text.size();
        if (text[at] == '\n' || text[at] == '\r') continue;
        text[at] = static_cast<char>(0x21 + random() % 0x5E);
        const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
        const auto right = read_program(written.text), read = read_program(text);
        if (!read.wrong().empty() && read.fault.line > 0) {
            ASSERT_GE(read.fault.line, line);
        }
        for (std::size_t i = 0; i < read.items.size() && read.items[i].line < line; ++i) {
            ASSERT_EQ(read.items[i].line, right.items[i].line);
            ASSERT_EQ(read.items[i].move.to, right.items[i].move.to);
        }
    }
}

TEST(GcodeProgram, StartedAtAnyLineGoesOnAsItDid) {
    for (std::size_t seed = 0; seed < property_cases(50); ++seed) {
        Writer written(static_cast<std::uint32_t>(seed) + 2'000'000);
        written.program(20);
        const auto whole = read_program(written.text);
        InterpreterOptions options;
        for (options.start_line = 2; options.start_line < whole.counts.lines; ++options.start_line) {
            const auto part = read_program(written.text, options);
            ASSERT_EQ(part.wrong(), "") << options.start_line;
            ASSERT_EQ(part.items.front().kind, ProgramItem::Kind::resume);
            std::size_t at = 0;
            while (whole.items[at].line < options.start_line) ++at;
            ASSERT_EQ(part.items.size() - 1, whole.items.size() - at);
            for (std::size_t i = 1; i < part.items.size(); ++i) {
                const auto &is = part.items[i], &was = whole.items[at + i - 1];
                ASSERT_EQ(is.line, was.line);
                ASSERT_EQ(is.move.from, was.move.from);
                ASSERT_EQ(is.move.to, was.move.to);
                ASSERT_EQ(is.move.feed.value, was.move.feed.value);
                ASSERT_EQ(is.move.angle, was.move.angle);
            }
        }
    }
}

}  // namespace
}  // namespace taktwerk::gcode
