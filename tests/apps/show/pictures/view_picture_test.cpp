// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "show/pictures/view_picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/expect_error.hpp"
#include "core/temporary_folder.hpp"
#include "show/pictures/picture_parts.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::app {
namespace {

struct Pixel {
  std::uint8_t r, g, b;
};

struct Image {
  int width = 0, height = 0;
  std::vector<Pixel> pixels;

  template <typename Predicate>
  [[nodiscard]] int count(const Predicate& predicate) const {
    int n = 0;
    for (const Pixel& p : pixels) n += predicate(p) ? 1 : 0;
    return n;
  }
};

// Grey images come back with three equal channels.
Image read_png(const std::filesystem::path& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&png, path.c_str()) == 0) return {};
  png.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.pixels.resize(static_cast<std::size_t>(png.width) * png.height);
  if (png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr) == 0) return {};
  return image;
}

// Nearness to the four colours of boundary classes, in the order left, right, top, bottom.
constexpr std::array<bool (*)(const Pixel&), 4> kIsOfClass{
    [](const Pixel& p) { return p.r > 200 && p.g < 60 && p.b < 70; },
    [](const Pixel& p) { return p.r < 80 && p.g > 160 && p.b < 90; },
    [](const Pixel& p) { return p.r < 60 && p.g < 110 && p.b > 210; },
    [](const Pixel& p) { return p.r > 220 && p.g > 185 && p.b < 40; }};
// Lit cubes: the hue counts, not the brightness.
bool is_orange(const Pixel& p) {
  return p.r > 120 && p.g > p.r / 2 && p.g < 0.72 * p.r && 3 * p.b < p.r;
}
bool is_ray_blue(const Pixel& p) {
  return p.b > 110 && p.g > 0.45 * p.b && p.g < 0.7 * p.b && 3 * p.r < p.b;
}
bool is_dark_green(const Pixel& p) { return p.r < 40 && p.g > 90 && p.g < 150 && p.b < 90; }
bool is_black(const Pixel& p) { return p.r < 50 && p.g < 50 && p.b < 50; }
bool is_surface_grey(const Pixel& p) {
  return p.r > 40 && p.r < 225 && p.r == p.g && p.b <= p.g && p.g - p.b <= 5;
}

// A quarter of a tube round the z axis, open on all sides, that turns its outside to +x. The border
// has 4 runs of 8 edges.
struct Sheet {
  SurfaceMesh surface;
  std::array<BoundaryRun, 4> runs;
};

Sheet make_sheet(bool inside_out = false) {
  constexpr std::uint32_t kSide = 9;
  constexpr double kRadius = 0.1;  // [m]
  Sheet sheet;
  for (std::uint32_t i = 0; i < kSide; ++i) {
    for (std::uint32_t j = 0; j < kSide; ++j) {
      const double azimuth = (i / 8.0 - 0.5) * std::numbers::pi / 2;
      const double z = 0.2 * (j / 8.0 - 0.5);
      const double c = std::cos(azimuth), s = std::sin(azimuth);
      sheet.surface.vertices.push_back({kRadius * c, kRadius * s, z});
      const double sign = inside_out ? -1 : 1;
      sheet.surface.normals.push_back({sign * c, sign * s, 0});
      sheet.surface.source.push_back(i * kSide + j);
    }
  }
  for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
    for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
      const std::uint32_t a = i * kSide + j, b = a + kSide;
      for (std::array<std::uint32_t, 3> t :
           {std::array<std::uint32_t, 3>{a, b, a + 1}, {a + 1, b, b + 1}}) {
        if (inside_out) std::swap(t[0], t[1]);
        sheet.surface.triangles.push_back(t);
      }
    }
  }
  for (std::uint32_t k = 0; k < kSide; ++k) {
    sheet.runs[0].vertices.push_back(k);
    sheet.runs[1].vertices.push_back(kSide * (kSide - 1) + k);
    sheet.runs[2].vertices.push_back(kSide * k + kSide - 1);
    sheet.runs[3].vertices.push_back(kSide * k);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    sheet.runs[k].boundary_class = static_cast<BoundaryClass>(k);
  }
  return sheet;
}

// In front of the sheet, a map with unknown and occupied voxels.
class ViewPictureTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const BeliefGrid grid = test::camel_grid(48);
    evaluator_ = std::make_unique<GainEvaluator>(VoxelScene::build(grid, {}), sensor_,
                                                 GainConfig{.model = GainModel::paper});
  }
  static void TearDownTestSuite() { evaluator_.reset(); }

  static Pose taken() { return look_at({0.6, 0.1, 0.2}, {0, 0, 0}); }
  static Pose chosen() { return look_at({0.3, 0.5, 0.25}, {0, 0, 0}); }

  [[nodiscard]] static ViewPicture picture(const SurfaceMesh& surface,
                                           const EstimatedViews& estimated,
                                           const std::vector<Candidate>& candidates = {},
                                           std::optional<Pose> next = {}) {
    return {surface, estimated, candidates, taken(), next, *evaluator_, sensor_};
  }

  [[nodiscard]] Image drawn(const ViewPicture& parts, int threads = 2) const {
    write_png(folder_ / "view.png", view_picture(parts, {.num_threads = threads}));
    return read_png(folder_ / "view.png");
  }

  [[nodiscard]] std::string bytes() const { return test::read_all(folder_ / "view.png"); }

  test::TemporaryFolder own_;
  const std::filesystem::path folder_ = own_.path();
  static inline const Sensor sensor_ = sensor_preset("sr4000");
  static inline std::unique_ptr<GainEvaluator> evaluator_;
};

TEST_F(ViewPictureTest, EachClassHasItsColor) {
  Sheet sheet = make_sheet();
  sheet.surface.triangles.clear();  // only the runs
  for (std::size_t k = 0; k < 4; ++k) {
    EstimatedViews estimated;
    estimated.runs = {sheet.runs[k]};
    const Image image = drawn(picture(sheet.surface, estimated));
    for (std::size_t c = 0; c < 4; ++c) {
      const int pixels = image.count(kIsOfClass[c]);
      const std::string what = "run " + std::to_string(k) + ", color " + std::to_string(c);
      EXPECT_EQ(pixels > 75, c == k) << what << ": " << pixels;
      EXPECT_EQ(pixels == 0, c != k) << what << ": " << pixels;
    }
  }
}

TEST_F(ViewPictureTest, CandidatesHaveTheColorOfTheirClass) {
  // Many more than are shown, the classes one after the other: an evenly spaced sample shows them
  // all.
  const std::vector<std::optional<BoundaryClass>> classes{BoundaryClass::left, BoundaryClass::right,
                                                          BoundaryClass::top, BoundaryClass::bottom,
                                                          std::nullopt};
  std::vector<Candidate> candidates;
  for (const Pose& pose : sphere_poses(1500, 0.5)) {
    candidates.push_back({pose, "test", classes[candidates.size() / 300], {}});
  }
  ASSERT_EQ(candidates.size(), 1500U);
  const Image image = drawn(picture({}, {}, candidates));
  for (std::size_t c = 0; c < 4; ++c) EXPECT_GT(image.count(kIsOfClass[c]), 300) << c;

  // Those without a class bring none of the colors.
  const Image grey = drawn(picture({}, {}, {candidates.begin() + 1200, candidates.end()}));
  for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(grey.count(kIsOfClass[c]), 0) << c;
}

TEST_F(ViewPictureTest, TheChosenViewBringsItsRays) {
  const std::vector<RayHit> hits = evaluator_->trace(chosen());
  int unknown = 0, occupied = 0;
  for (const RayHit& hit : hits) {
    unknown += hit.kind == RayHit::Kind::unknown ? 1 : 0;
    occupied += hit.kind == RayHit::Kind::occupied ? 1 : 0;
  }
  ASSERT_GT(unknown, 1000);
  ASSERT_GT(occupied, 1000);

  // The chosen one stands in the list of candidates too, and is not drawn as one of them.
  const std::vector<Candidate> candidates{{chosen(), "test", BoundaryClass::left}};
  const Sheet sheet = make_sheet();
  const Image with = drawn(picture(sheet.surface, {}, candidates, chosen()));
  EXPECT_EQ(with.width, 640);
  EXPECT_EQ(with.height, 480);
  EXPECT_GT(with.count(is_orange), 75);
  EXPECT_GT(with.count(is_ray_blue), 75);
  EXPECT_GT(with.count(is_dark_green), 250);
  EXPECT_GT(with.count(is_black), 50);
  EXPECT_EQ(with.count(kIsOfClass[0]), 0);

  const Image without = drawn(picture(sheet.surface, {}));
  EXPECT_EQ(without.width, 640);
  EXPECT_EQ(without.height, 480);
  EXPECT_EQ(without.count(is_orange), 0);
  EXPECT_EQ(without.count(is_ray_blue), 0);
  EXPECT_EQ(without.count(is_dark_green), 0);
  EXPECT_GT(without.count(is_black), 50);
}

TEST_F(ViewPictureTest, TheSurfaceGainShowsWhereSurfaceMayBe) {
  const GainEvaluator surface(VoxelScene::build(test::camel_grid(48)), sensor_,
                              {.model = GainModel::surface});
  const Pose behind = look_at({-0.3, -0.5, 0.25}, {0, 0, 0});  // whence nothing was seen
  const SurfaceMesh nothing;
  const EstimatedViews none;
  ViewPicture parts{nothing, none, {}, taken(), behind, surface, sensor_};
  const int all = drawn(parts).count(is_orange);
  const std::vector<VoxelContribution> untouched;
  parts.contributions = &untouched;
  EXPECT_GT(all, drawn(parts).count(is_orange) + 1000);
}

TEST_F(ViewPictureTest, SamePictureForAnyNumberOfThreads) {
  const Sheet sheet = make_sheet();
  EstimatedViews estimated;
  estimated.runs.assign(sheet.runs.begin(), sheet.runs.end());
  const std::vector<Candidate> candidates{{look_at({0.5, -0.3, 0.2}, {0, 0, 0}), "test"}};
  const ViewPicture parts = picture(sheet.surface, estimated, candidates, chosen());
  (void)drawn(parts, 1);
  const std::string one = bytes();
  ASSERT_GT(one.size(), 10000U);
  (void)drawn(parts, 2);
  EXPECT_EQ(one, bytes());
}

TEST(Pictures, AreTheSameWhereverTheOriginIs) {
  const auto picture = [](const Eigen::Vector3d& o) {
    PaintedMesh scene;
    const std::uint8_t grey = scene.add_paint({.color = {0.6, 0.6, 0.6}});
    const std::uint8_t black = scene.add_paint({.color = {0, 0, 0}, .lit = false});
    for (int i = 0; i < 40; ++i) {
      add_lattice_cube(scene, Pose(Eigen::Matrix3d::Identity(), o),
                       {i % 5 - 2.0, i * 3 % 8 - 4.0, i % 7 - 3.0}, 0.02, grey);
    }
    scene.add_line(o - Eigen::Vector3d(0.1, 0.1, 0), o + Eigen::Vector3d(0.1, 0.1, 0.1), 0.01,
                   black);
    PinholeCamera camera = picture_camera(160);
    const Pose viewer =
        place_viewer({o - Eigen::Vector3d::Constant(0.1), o + Eigen::Vector3d::Constant(0.1)},
                     Eigen::Vector3d(2, 3, 1).normalized(), camera);
    return render(scene, camera, viewer, 0.05, {}).pixels;
  };
  const std::vector<std::uint8_t> here = picture({0, 0, 0}), there = picture({5e5, 4.5e6, 400});
  std::size_t other = 0, dark = 0;
  for (std::size_t i = 0; i < here.size(); ++i) {
    other += std::abs(here[i] - there[i]) > 12 ? 1U : 0U;
    dark += here[i] < 40 ? 1U : 0U;
  }
  EXPECT_LT(other, here.size() / 200);
  EXPECT_GT(dark, here.size() / 200);
  PinholeCamera camera = picture_camera();
  test::expect_error(ErrorCode::invalid_argument, "cannot show", [&] {
    (void)place_viewer({{0, 0, 0}, {0, 2e6, 0}}, Eigen::Vector3d::UnitX(), camera);
  });
}

TEST_F(ViewPictureTest, TheSurfaceIsShadedAndDarkerFromBehind) {
  const auto mean_grey = [](const Image& image) {
    double sum = 0;
    int pixels = 0;
    for (const Pixel& p : image.pixels) {
      if (!is_surface_grey(p)) continue;
      sum += p.r;
      ++pixels;
    }
    EXPECT_GT(pixels, 1200);
    return sum / pixels;
  };
  const Sheet front = make_sheet(), back = make_sheet(true);
  EXPECT_GT(mean_grey(drawn(picture(front.surface, {}))),
            1.1 * mean_grey(drawn(picture(back.surface, {}))));
  EXPECT_LT(drawn(picture({}, {})).count(is_surface_grey), 125);
}

TEST_F(ViewPictureTest, RefusesWhatItCannotDraw) {
  const SurfaceMesh nothing;
  const EstimatedViews none;
  Pose bad = chosen();
  bad.m[0] += 0.1;
  test::expect_error(ErrorCode::invalid_argument, "", [&] {
    (void)view_picture(picture(nothing, none, {}, bad), {.num_threads = 1});
  });

  // A candidate that is no pose is left out.
  const std::vector<Candidate> candidates{{bad, "test", BoundaryClass::left}};
  EXPECT_EQ(drawn(picture(nothing, none, candidates)).count(kIsOfClass[0]), 0);
}

TEST_F(ViewPictureTest, AmplitudesAreDrawnByTheirSquareRoot) {
  // 100 columns: amplitude 4 k², but for the last column, which outshines the percentile.
  DepthFrame frame{100, 3, std::vector<float>(300, 1.0F), {}};
  for (int i = 0; i < 300; ++i) {
    const float k = static_cast<float>(i % 100);
    frame.amplitude.push_back(i % 100 == 99 ? 1e9F : 4 * k * k);
  }
  frame.amplitude[100] = std::numeric_limits<float>::quiet_NaN();
  frame.amplitude[200] = -1;
  write_amplitude_picture(folder_ / "a.png", frame);
  const Image image = read_png(folder_ / "a.png");
  ASSERT_EQ(image.width, 500);  // 5 is the least factor that reaches 480
  ASSERT_EQ(image.height, 15);
  for (int v = 0; v < 15; ++v) {
    for (int u = 0; u < 500; ++u) {
      // White is column 98: 98 % of the 297 positive values lie under it, 99 % up to it.
      const int expected = static_cast<int>(std::lround(255 * std::min(u / 5, 98) / 98.0));
      const Pixel& p = image.pixels[static_cast<std::size_t>(500 * v + u)];
      ASSERT_EQ(p.r, expected) << u << ' ' << v;
      ASSERT_EQ(p.g, p.r);
      ASSERT_EQ(p.b, p.r);
    }
  }
}

}  // namespace
}  // namespace viewgain::app
