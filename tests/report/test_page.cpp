#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "expect.h"
#include "machine.h"
#include "page.h"
#include "page_pictures.h"
#include "page_template.h"
#include "png.h"
#include "report.h"
#include "report_json.h"
#include "report_text.h"

namespace brisance {
namespace {

// Bytes of all chunks of a type.
std::string chunk(const std::string& png, const std::string& type) {
    std::string data;
    const auto number = [&](std::size_t at) {
        std::size_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8 | static_cast<unsigned char>(png[at + i]);
        return value;
    };
    for (std::size_t at = 8; at < png.size(); at += number(at) + 12) {
        const std::string body = png.substr(at + 4, number(at) + 4);
        EXPECT_EQ(number(at + 8 + number(at)),
                  crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
        if (body.substr(0, 4) == type)
            data += body.substr(4);
    }
    return data;
}

std::string inflated(const std::string& data, std::size_t size) {
    std::string out(size, '\0');
    uLongf length = size;
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &length, reinterpret_cast<const Bytef*>(data.data()),
                         static_cast<uLong>(data.size())),
              Z_OK);
    EXPECT_EQ(length, size);
    return out;
}

TEST(Base64, OfTheStandardsExamples) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Png, HoldsIndicesAsTheyAre) {
    const std::vector<std::uint8_t> indices = {0, 1, 1, 0, 1, 0}, palette = {0, 0, 0, 255, 128, 0};
    const std::string png = encode_indexed_png(3, 2, indices, palette);
    EXPECT_EQ(chunk(png, "IHDR"), std::string("\0\0\0\3\0\0\0\2\10\3\0\0\0", 13));
    EXPECT_EQ(chunk(png, "PLTE"), std::string(palette.begin(), palette.end()));
    EXPECT_EQ(inflated(chunk(png, "IDAT"), 8), std::string("\0\0\1\1\0\0\1\0", 8));
}

TEST(Png, HoldsColoursUnderSomeFilter) {
    // Rows that grow evenly: undoing the filters must give them back.
    constexpr int width = 5, height = 4;
    std::vector<std::uint8_t> rgb;
    for (int i = 0; i < 3 * width * height; ++i)
        rgb.push_back(static_cast<std::uint8_t>(7 * i));
    const std::string rows = inflated(chunk(encode_png(width, height, rgb), "IDAT"), (3 * width + 1) * height);
    std::vector<std::uint8_t> back(rgb.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < 3 * width; ++x) {
            const auto at = [&](int column, int row) {
                return column < 0 || row < 0 ? 0 : int{back[static_cast<std::size_t>(row * 3 * width + column)]};
            };
            const int left = at(x - 3, y), above = at(x, y - 1), corner = x < 3 ? 0 : at(x - 3, y - 1);
            const int p = left + above - corner;
            const int a = std::abs(p - left), b = std::abs(p - above), c = std::abs(p - corner);
            const int guesses[] = {0, left, above, (left + above) / 2,
                                   a <= b && a <= c ? left
                                   : b <= c         ? above
                                                    : corner};
            const int filter = static_cast<unsigned char>(rows[static_cast<std::size_t>(y * (3 * width + 1))]);
            ASSERT_LT(filter, 5);
            back[static_cast<std::size_t>(y * 3 * width + x)] = static_cast<std::uint8_t>(
                rows[static_cast<std::size_t>(y * (3 * width + 1) + 1 + x)] + guesses[filter]);
        }
    EXPECT_EQ(back, rgb);
}

TEST(ReducedPictures, KeepTheMean) {
    Picture picture{7, 5, {}};
    for (int i = 0; i < 35; ++i)
        picture.pixels.push_back(Rgb(float(i), float(i % 3), 1.0f));
    const Picture small = reduced(picture, 3);
    ASSERT_EQ(small.width, 3);
    ASSERT_EQ(small.height, 2);
    dvec3 before(0.0), after(0.0);
    for (const Rgb& pixel : picture.pixels)
        before += dvec3(pixel) / 35.0;
    for (const Rgb& pixel : small.pixels)
        after += dvec3(pixel) / 6.0;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(before[c], after[c], 1e-5);
    EXPECT_EQ(reduced(picture, 7).pixels, picture.pixels);
}

TEST(RelativeErrors, AreShownOnThreeDecades) {
    const Picture reference{5, 1, {Rgb(1.0f), Rgb(1.0f), Rgb(1.0f), Rgb(1.0f), Rgb(0.0f)}};
    const Picture image{5, 1, {Rgb(1.0f), Rgb(1.01f), Rgb(0.9f), Rgb(3.0f), Rgb(0.0f)}};
    const Plane map = relative_error_map(image, reference, 0.0);
    EXPECT_FLOAT_EQ(map.values[0], 0.0f);
    EXPECT_NEAR(map.values[1], 1.0f / 3.0f, 1e-3);
    EXPECT_NEAR(map.values[2], 2.0f / 3.0f, 1e-3);
    EXPECT_FLOAT_EQ(map.values[3], 1.0f);
    EXPECT_FLOAT_EQ(map.values[4], 0.0f);
    const Picture broken{5, 1, std::vector<Rgb>(5, Rgb(NAN))};
    EXPECT_FLOAT_EQ(relative_error_map(broken, reference, 0.0).values[4], 1.0f);
}

TEST(ReportPage, CannotBeEndedByAName) {
    const nlohmann::ordered_json json = {{"name", "</script><script>alert(1)</script><!--"}, {"bad", "\xff"}};
    const std::string text = script_json(json);
    EXPECT_LACKS(text, "<");
    EXPECT_EQ(nlohmann::ordered_json::parse(text)["name"], json["name"]);
    const std::string page = report_page(json, {{"pictures", 1}});
    EXPECT_LACKS(page, "alert(1)</script>");
    EXPECT_HAS(page, "id=\"report-data\"");
    EXPECT_LACKS(page, "<!--DATA-->");
}

TEST(ReportPage, NeedsNothingFromElsewhere) {
    const std::string page(page_template());
    for (const char* text : {"src=\"http", "href=\"http", "url(http", "@import", "sourceMappingURL"})
        EXPECT_LACKS(page, text);
    for (const char* text : {"Leon Sorokin", "Dmitry Snisarenko", "Permission is hereby granted"})
        EXPECT_HAS(page, text) << "the licences stay with the code";
}

TEST(ShellWords, AreQuotedWhereTheyMustBe) {
    EXPECT_EQ(shell_quoted("tracing.samples=16"), "tracing.samples=16");
    EXPECT_EQ(shell_quoted("smoke.albedo=[1,0,0]"), "'smoke.albedo=[1,0,0]'");
    EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
    EXPECT_EQ(shell_quoted(""), "''");
    EXPECT_EQ(shell_quoted("fire.####.vdb"), "'fire.####.vdb'");
}

TEST(Machine, IsDescribed) {
    const Machine machine = this_machine();
    EXPECT_FALSE(machine.processor.empty());
    EXPECT_GE(machine.cores, 1);
    EXPECT_GE(machine.logical, machine.cores);
    EXPECT_GE(machine.threads, 1);
    EXPECT_GT(machine.memory_bytes, 0u);
}

TEST(Date, IsTheOneThatIsGiven) {
    setenv("SOURCE_DATE_EPOCH", "86399", 1);
    EXPECT_EQ(report_date(), "1970-01-01T23:59:59Z");
    setenv("SOURCE_DATE_EPOCH", "today", 1);
    EXPECT_ANY_THROW(report_date());
    unsetenv("SOURCE_DATE_EPOCH");
    EXPECT_EQ(report_date().size(), 20u);
}

// Two methods: one that averages and one with a floor of 3.5 %.
Report small_report() {
    Report report;
    report.shot.name = "\"a\", b";
    report.shot.json = "{}";
    report.layers = {""};
    report.machine.threads = 1;
    report.reference.halves = true;
    report.reference.noise[""] = 0.01;
    for (const bool averages : {false, true}) {
        MethodResult result;
        result.method.label = averages ? "path" : "grid";
        result.method.base = averages ? "path" : "lighting_grid";
        result.method.unbiased = result.method.averages = averages;
        for (const double seconds : {1.0, 4.0, 16.0}) {
            MeasuredRun run;
            run.cost = {seconds, seconds};
            run.errors[""].noise_free = (averages ? 0.4 : 0.06) / std::sqrt(seconds) + (averages ? 0.0 : 0.02);
            result.runs.push_back(run);
        }
        report.methods.push_back(result);
    }
    return report;
}

TEST(Tables, QuoteWhatHoldsCommas) {
    EXPECT_HAS(measurements_csv(small_report()), "\r\n\"\"\"a\"\", b\",0,grid,");
}

// The row of a method in the CSV, by column.
std::map<std::string, std::string> first_row(const std::string& csv) {
    const std::size_t end = csv.find("\r\n");
    std::stringstream head(csv.substr(0, end)), row(csv.substr(end + 2, csv.find("\r\n", end + 2) - end - 2));
    std::map<std::string, std::string> fields;
    for (std::string name, field; std::getline(head, name, ',');) {
        std::getline(row, field, ',');
        fields[name] = field;
    }
    return fields;
}

TEST(Tables, HaveTheSpreadOfRepeatsAndNothingWithout) {
    Report report = small_report();
    report.shot.name = "plain";
    for (const char* const column : {"rrmse_noise_free_sd", "rrmse_sd", "bias_sd", "hdr_flip_sd"})
        EXPECT_EQ(first_row(measurements_csv(report)).at(column), "") << column;
    report.repeats = 4;
    ErrorSpread spread;
    spread.noise_free = 0.25;
    spread.rrmse = 0.5;
    spread.mean = 0.125;
    report.methods[0].runs[0].errors[""].spread = spread;
    const auto fields = first_row(measurements_csv(report));
    EXPECT_EQ(fields.at("repeats"), "4");
    EXPECT_EQ(fields.at("rrmse_noise_free_sd"), "0.25");
    EXPECT_EQ(fields.at("rrmse_sd"), "0.5");
    EXPECT_EQ(fields.at("bias_sd"), "0.125");
    const auto runs = report_json(report)["methods"][0]["runs"];
    EXPECT_EQ(runs[0]["errors"][""]["spread"]["noise_free"], 0.25);
    EXPECT_TRUE(runs[1]["errors"][""]["spread"].is_null());
}

TEST(Tables, CompareTheTimesOfMethods) {
    const Report report = small_report();
    EXPECT_EQ(baseline(report), 1u) << "the one that reaches every error";
    const std::string text = times_table(report);
    EXPECT_HAS(text, "not reached (bias floor 3.5 %)");
    EXPECT_HAS(text, "<= 1 s");
    EXPECT_HAS(text, "16 s (1.0x)");
    EXPECT_HAS(text, "~ 64 s (1.0x)");
    EXPECT_HAS(times_csv(report), "grid,beauty,wall,0.02,,not_reached,");
    EXPECT_HAS(times_csv(report), "path,beauty,cpu,0.05,64,extrapolated,1,");
}

TEST(Json, HasTheNumbersOfTheTables) {
    const nlohmann::ordered_json json = report_json(small_report());
    const auto& wall = json["methods"][1]["convergence"][""]["wall"];
    EXPECT_NEAR(wall["slope"].get<double>(), -0.5, 1e-12);
    EXPECT_EQ(wall["times"][0]["kind"], "interpolated");
    EXPECT_NEAR(wall["times"][0]["seconds"].get<double>(), 16.0, 1e-9);
    EXPECT_TRUE(json["methods"][0]["convergence"][""]["wall"]["times"][3]["seconds"].is_null());
    EXPECT_EQ(json["equal_times"]["wall"], (std::vector<double>{1, 2, 5, 10}));
}

}  // namespace
}  // namespace brisance
