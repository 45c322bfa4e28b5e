// EnableCore against figures 5 and 6 of PLCopen Part 1 v2.0, 2.2.3.
#include "fb_library/motion/enable_core.hpp"

#include <gtest/gtest.h>

namespace taktwerk::fb {
namespace {

struct Outputs {
    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
};

struct Step {
    const char* event;
    bool enable;
    Reading reading;
    bool busy, valid, error;
};

void replay(std::initializer_list<Step> steps) {
    EnableCore core;
    for (const Step& step : steps) {
        core.begin(step.enable);
        if (core.working()) core.took(step.reading);
        Outputs out;
        core.publish(out);
        EXPECT_EQ(out.Busy, step.busy) << step.event;
        EXPECT_EQ(out.Valid, step.valid) << step.event;
        EXPECT_EQ(out.Error, step.error) << step.event;
        EXPECT_EQ(out.ErrorID != ErrorId::none, step.error) << step.event;
    }
}

constexpr Reading nothing_yet{};
constexpr Reading good = Reading::valid();
constexpr Reading passing = Reading::unless(ErrorId::drive_not_ready);
constexpr Reading final_one = Reading::final_error(ErrorId::not_supported);

// P1-049, P1-069
TEST(EnableCoreFigure5, AnErrorThatClearsItself) {
    replay({{"Enable rises", true, nothing_yet, true, false, false},
            {"some time later", true, good, true, true, false},
            {"Enable falls", false, good, false, false, false},
            {"Enable rises again", true, good, true, true, false},
            {"error appears", true, passing, true, false, true},
            {"error disappears", true, good, true, true, false}});
}

// P1-050
TEST(EnableCoreFigure6, AnErrorThatDoesNotClearItself) {
    replay({{"Enable rises", true, nothing_yet, true, false, false},
            {"some time later", true, good, true, true, false},
            {"error appears", true, final_one, false, false, true},
            {"its cause has gone", true, good, false, false, true},
            {"Enable falls", false, good, false, false, false},
            {"Enable rises", true, good, true, true, false}});
}

}  // namespace
}  // namespace taktwerk::fb
