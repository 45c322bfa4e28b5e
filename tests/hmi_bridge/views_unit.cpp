// The machine builder's own pages at the socket: what a page is told, which pictures are taken.
#include "hmi_bridge/views/image_file.hpp"
#include "hmi_bridge/views/view_answers.hpp"
#include "hmi_bridge/views/view_check.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

namespace taktwerk::hmi {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

runtime::MachineConfig cell_config() {
    runtime::MachineConfig config;
    runtime::AxisBinding x;
    x.axis.name = "x";
    x.axis.unit = "mm";
    x.axis.limits.position_min = -10;
    x.axis.limits.position_max = 800;
    config.axes.push_back(x);
    runtime::IoPoint door;
    door.name = "door";
    config.io.push_back(door);
    config.programs.push_back({});
    config.programs.back().name = "cell";
    return config;
}

runtime::MachineLayout cell_layout() {
    runtime::MachineLayout layout;
    layout.variables = {{"cell", "pieces", "", "", VariableType::int64},
                        {"cell", "start", "", "", VariableType::boolean, true, true, 0, 1},
                        {"cell", "tempo", "mm/s", "", VariableType::real, true, false, 10, 100}};
    layout.parameters = {{"cell", "pause", "s", "", 0, 5, 1}};
    return layout;
}

ViewWidget widget(ViewWidget::Kind kind, std::string name) {
    ViewWidget w;
    w.kind = kind;
    w.names = {{std::move(name), "machine.yaml:5:9"}};
    w.where = "machine.yaml:5:3";
    return w;
}

View view_of(std::vector<ViewWidget> row) {
    View view;
    view.name = "page";
    view.title = {"Page", "页面"};
    view.rows = {std::move(row)};
    return view;
}

using Kind = ViewWidget::Kind;

TEST(ViewAnswer, BindsEachValueAndSaysHowItIsWritten) {
    auto lamp = widget(Kind::lamp, "in.door");
    lamp.tone = ViewWidget::Tone::bad;
    lamp.label = {"Door", "门"};
    const auto made = ViewAnswers::make(
        {view_of({widget(Kind::bar, "x.actual_position"), lamp, widget(Kind::set, "cell.tempo"), widget(Kind::axis, "x")})},
        view_values_of(cell_config(), cell_layout()));
    ASSERT_TRUE(made) << made.error().text();
    const auto views = json::parse(made->views());
    ASSERT_EQ(views.size(), 1u);
    EXPECT_EQ(views[0]["title"], (json{{"en", "Page"}, {"zh", "页面"}}));
    const auto& row = views[0]["rows"][0];
    EXPECT_EQ(row[0]["values"][0], (json{{"name", "x.actual_position"},
                                         {"source", "axis"},
                                         {"of", "x"},
                                         {"member", "actual_position"},
                                         {"form", "number"},
                                         {"unit", "mm"},
                                         {"whole", false},
                                         {"minimum", -10},
                                         {"maximum", 800}}));
    EXPECT_EQ(row[1]["kind"], "lamp");
    EXPECT_EQ(row[1]["tone"], "bad");
    EXPECT_EQ(row[1]["label"]["zh"], "门");
    EXPECT_EQ(row[1]["values"][0]["source"], "input");
    EXPECT_EQ(row[1]["values"][0]["of"], "door");
    EXPECT_EQ(row[2]["values"][0]["writable"], true);
    EXPECT_EQ(row[2]["values"][0]["maximum"], 100);
    EXPECT_EQ(row[3]["axis"], "x");
}

TEST(ViewAnswer, WithoutViewsThereIsAnEmptyListAndNoPicture) {
    const ViewAnswers none;
    EXPECT_EQ(none.views(), "[]");
    EXPECT_FALSE(none.image("cell.svg"));
}

TEST(ViewCheck, WhatProgramsHaveIsSaidOnceTheyAreKnownAndNothingTwice) {
    const std::vector<View> views{
        view_of({widget(Kind::value, "cell.peices"), widget(Kind::value, "in.dor"), widget(Kind::button, "cell.tempo"),
                 widget(Kind::toggle, "cell.start"), widget(Kind::set, "cell.pieces"), widget(Kind::set, "cell.pause"),
                 widget(Kind::bar, "cell.pieces"), widget(Kind::trend, "cell.pause")})};
    const auto before = check(views, view_values_of(cell_config()));
    ASSERT_EQ(before.size(), 1u);
    EXPECT_THAT(before[0].what, HasSubstr("'in.dor'"));
    const auto behind = check(views, view_values_of(cell_config(), cell_layout()));
    ASSERT_EQ(behind.size(), 6u);
    EXPECT_EQ(behind[0].code, "view.unknown_name");
    EXPECT_EQ(behind[0].subject, "machine.yaml:5:9");
    EXPECT_THAT(behind[0].remedy, HasSubstr("did you mean `cell.pieces`?"));
    EXPECT_THAT(behind[1].remedy, HasSubstr("operator_button")) << "a number is not pressed";
    EXPECT_THAT(behind[2].remedy, HasSubstr("write `button: cell.start`")) << "a button does not stay";
    EXPECT_THAT(behind[3].remedy, HasSubstr("operator_value")) << "the program counts the pieces";
    EXPECT_EQ(behind[4].code, "view.range");
    EXPECT_THAT(behind[5].what, HasSubstr("not recorded"));
}

// --- pictures ---------------------------------------------------------------------------------------------------------------------

TEST(ViewPicture, IsKnownByItsFirstBytes) {
    EXPECT_EQ(judge_image("\x89PNG\r\n\x1a\n....").value().type, "image/png");
    EXPECT_EQ(judge_image("\xFF\xD8\xFF\xE0....").value().type, "image/jpeg");
    for (const char* svg :
         {"<svg xmlns='http://www.w3.org/2000/svg'/>", "\xEF\xBB\xBF<?xml version='1.0'?>\n<!-- drawn -->\n<svg><g/></svg>"})
        EXPECT_EQ(judge_image(svg).value().type, "image/svg+xml") << svg;
    for (const char* other : {"", "GIF89a", "<html><svg/></html>", "<?xml version='1.0'?><html/>", "\x89PNG", "MZ"})
        EXPECT_EQ(judge_image(other).error().code, "view.image_type") << other;
}

TEST(ViewPicture, NothingInItRunsOrIsFetched) {
    for (const char* inside :
         {"<script>x()</script>", "<SCRIPT href='#a'/>", "<g onclick='x()'/>", "<g\nONLOAD = \"x()\"/>", "<a href='javascript:x()'/>",
          "<foreignObject/>", "<image href='http://a/b.png'/>", "<image xlink:href=\"//a/b.png\"/>", "<image href = 'file:///etc/passwd'/>",
          "<style>@import 'a.css'</style>", "<g style='fill:url(http://a/b)'/>", "<use href='other.svg#a'/>",
          "<!DOCTYPE svg [<!ENTITY a 'b'>]>", "<iframe src='a'/>", "<image href='data:text/html,a'/>"})
        EXPECT_EQ(judge_image(std::string("<svg>") + inside + "</svg>").error().code, "view.image_active") << inside;
    for (const char* harmless : {"<text>on the way; one = two</text>", "<use href='#part'/>", "<g fill='url(#shade)'/>",
                                 "<image href='data:image/png;base64,AAAA'/>", "<g id='position' x='1'/>", "<rect font-size='2' rx='1'/>"})
        EXPECT_TRUE(judge_image(std::string("<svg>") + harmless + "</svg>")) << harmless;
}

TEST(ViewPicture, IsSmallAndAFile) {
    EXPECT_EQ(judge_image("\x89PNG\r\n\x1a\n" + std::string(largest_image, 'x')).error().code, "view.image_size");
    EXPECT_TRUE(judge_image("\x89PNG\r\n\x1a\n" + std::string(largest_image - 8, 'x')));
    EXPECT_EQ(read_image("/nowhere/a.png").error().code, "view.no_image");
    EXPECT_EQ(read_image(testing::TempDir()).error().code, "view.no_image");
    EXPECT_EQ(read_image("/dev/zero").error().code, "view.no_image");
    const auto path = testing::TempDir() + "/views_unit.png";
    std::ofstream(path, std::ios::binary) << "\x89PNG\r\n\x1a\n1";
    ViewWidget image;
    image.kind = Kind::image;
    image.image = "cell.png";
    image.image_path = path;
    const auto made = ViewAnswers::make({view_of({image})}, view_values_of(cell_config(), cell_layout()));
    ASSERT_TRUE(made) << made.error().text();
    EXPECT_EQ(made->image("cell.png"), R"("media_type":"image/png","data":"iVBORw0KGgox")");  // RFC 4648 of 89 50 4e 47 0d 0a 1a 0a 31
    std::filesystem::remove(path);
    const auto gone = ViewAnswers::make({view_of({image})}, view_values_of(cell_config(), cell_layout()));
    ASSERT_FALSE(gone);
    EXPECT_EQ(gone.error().code, "view.no_image");
}

}  // namespace
}  // namespace taktwerk::hmi
