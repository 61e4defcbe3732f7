// SPDX-License-Identifier: MIT
#include "fuzz/seeds.h"

#include <string>

#include "crossnav/core/png_image.h"
#include "crossnav/evaluation/episodes/episodes.h"
#include "crossnav/evaluation/episodes/suite.h"
#include "crossnav/evaluation/lifelong/visits.h"
#include "crossnav/evaluation/records/result_records.h"
#include "crossnav/evaluation/settings/config_file.h"
#include "crossnav/geometry/map_blocks.h"
#include "crossnav/perception/goal_picture.h"
#include "crossnav/store/block_codec.h"
#include "crossnav/store/map_file.h"
#include "crossnav/trace/preview.h"
#include "crossnav/trace/replay_json.h"
#include "crossnav/trace/replay_writer.h"
#include "crossnav/trace/trace_json.h"
#include "crossnav/trace/voxel_codec.h"
#include "crossnav/world/change/changes.h"
#include "crossnav/world/furniture/furniture_pack.h"
#include "evaluation/record_builder.h"
#include "fuzz/plain_mcap.h"
#include "homes/home_maker.h"
#include "sim/glb_maker.h"
#include "store/small_world.h"
#include "support/building_maker.h"
#include "support/text_file.h"
#include "trace/sample_episode.h"

namespace crossnav::fuzz {
namespace {

namespace fs = std::filesystem;
using crossnav::test::ReadText;
using crossnav::test::WriteText;

class Seeds {
 public:
  explicit Seeds(fs::path folder) : folder_(std::move(folder)) {}

  fs::path Path(const char* target, const char* name) const {
    fs::create_directories(folder_ / target);
    return folder_ / target / name;
  }
  void Put(const char* target, const char* name, const std::string& bytes) const {
    WriteText(Path(target, name), bytes);
  }
  /// Of files that a writer wrote to a path.
  void Move(const char* target, const char* name, const fs::path& from) const {
    Put(target, name, ReadText(from));
    fs::remove(from);
  }
  fs::path Scratch(const char* name) const { return folder_ / name; }

 private:
  fs::path folder_;
};

std::string SmallPng() {
  RgbImage image(8, 8);
  image.At(3, 4) = {200, 10, 90};
  return EncodePng(image);
}

std::string SmallGlb() {
  sim::test::GlbMaker maker;
  using nlohmann::json;
  const std::string png = SmallPng();
  const int view = maker.View(std::vector<char>(png.begin(), png.end()));
  maker.json["images"] = json::array({{{"bufferView", view}, {"mimeType", "image/png"}}});
  maker.json["textures"] = json::array({{{"source", 0}}});
  maker.json["materials"] =
      json::array({{{"pbrMetallicRoughness",
                     {{"baseColorTexture", {{"index", 0}}}, {"baseColorFactor", {1, 0.5, 0.5, 1}}}},
                    {"alphaMode", "MASK"}}});
  const std::vector<float> uvs = {0, 0, 1, 0, 1, 1, 0, 1};
  const std::vector<std::uint8_t> colours = {255, 0, 0, 255, 0, 255, 0, 255,
                                             255, 0, 0, 255, 0, 255, 0, 255};
  const int position = maker.Positions(sim::test::SquareCorners());
  const int uv = maker.Accessor(uvs, sim::test::GlbMaker::kFloat, "VEC2", 2);
  const int colour = maker.Accessor(colours, sim::test::GlbMaker::kByte, "VEC4", 4, true);
  const std::vector<std::uint16_t> corners = {0, 1, 2, 0, 2, 3};
  const int indices = maker.Accessor(corners, sim::test::GlbMaker::kShort, "SCALAR", 1);
  maker.AddMesh({{"attributes", {{"POSITION", position}, {"TEXCOORD_0", uv}, {"COLOR_0", colour}}},
                 {"indices", indices},
                 {"material", 0}},
                {{"name", "square"}, {"translation", {1, 2, 3}}, {"rotation", {0, 0, 0, 1}}});
  maker.AddRoot({{"children", {0}}, {"scale", {2, 2, 2}}});
  const auto bytes = maker.Bytes();
  return {bytes.begin(), bytes.end()};
}

void AddScenes(const Seeds& seeds) {
  seeds.Put("glb", "square.glb", SmallGlb());
  seeds.Put("glb", "triangle.gltf",
            R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
            R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":5}]}],)"
            R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],)"
            R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":)"
            R"("data:application/octet-stream;base64,)"
            R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  seeds.Put("semantic_glb", "square.glb", SmallGlb());
  seeds.Put("semantic_text", "lines.txt",
            "HM3D Semantic Annotations\n1,FF0000,\"dining chair\",0\n2,00FF00,\"bed, double\",1\n");
  seeds.Put("semantic_text", "categories.tsv", "# raw\tcategory\ncouch\tsofa\n");
  seeds.Put("image", "small.png", SmallPng());
  seeds.Put("image", "small.jpg", trace::EncodeJpeg(RgbImage(16, 16), 80));
  seeds.Put("image", "depth.png", trace::EncodeDepthPng(Image<std::uint16_t>(8, 8), 10));
  seeds.Put("image", "depth.pgm", "P5 2 2 65535\n12345678");
  seeds.Put("npy", "rows.npy",
            std::string("\x93NUMPY\x01\x00\x46\x00", 10) +
                "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }          \n" +
                std::string("\0\0\x80\x3f\0\0\0\0\0\0\x80\x3f\0\0\0\x40", 16));
}

void AddHouses(const Seeds& seeds) {
  seeds.Put("house", "House.house.json",
            R"({"format":1,"scene":"00001-House","rooms":[{"region":0,"name":"kitchen","level":0,)"
            R"("floor_m":0.0,"rects":[[0,0,3,4],[3,0,5,2]]}],"credits":[]})");
  seeds.Put("objects", "objects.json",
            R"({"format":1,"up":"y","unit_m":0.01,"objects":[{"id":"a","name":"chair","parts":)"
            R"(["Chair*"],"room":1},{"category":"bed","box":{"center":[0,0,0],"size":[1,2,3],)"
            R"("yaw_deg":30}},{"name":"sofa","box":{"min":[0,0,0],"max":[1,1,1]}}]})");
  seeds.Put("building", "two_rooms.json", crossnav::test::TwoRooms());
  const auto entries = homes::test::TwoStoreyHome();
  seeds.Put("home", "two.sh3d", crossnav::test::Zip(entries));
  seeds.Put("home_xml", "Home.xml", entries.at("Home.xml"));
  seeds.Put("zip", "small.zip", crossnav::test::Zip({{"a", "text"}, {"b/c.txt", ""}}));
  seeds.Put("obj", "box.obj",
            entries.at("3/bed.obj") + std::string(1, '\0') +
                "newmtl cover\nKd 1 0 0\nd 0.5\nmap_Kd picture.png\n");
  seeds.Put("obj", "door.obj", homes::test::DoorObj() + "vt 0 0.5\nf 1/1 -2/-1/1 3//1\n");
}

void AddChanges(const Seeds& seeds) {
  world::ChangePlace place;
  place.p_world = {1, 2.5, 0};
  place.box.Add({0.5, 2, 0});
  place.box.Add({1.5, 3, 0.8});
  place.room = 2, place.floor = 0, place.support = 7;
  using world::ChangeKind;
  const world::DayChanges day = {
      "00001-House-day2",
      "00001-House-day1",
      2,
      7,
      {{ChangeKind::kOtherFloor, 5, "dining chair", "chair", place, place},
       {ChangeKind::kRemoved, 6, "vase", "", place, {}}},
      {{ChangeKind::kDoorClosed, 9, "door", "", {}, place}}};
  seeds.Put("changes", "day2.changes.json", world::ChangesText(day));
}

void AddPack(const Seeds& seeds) {
  world::PackModel chair;
  chair.entry = {"a", "chair", "Chair", "B", "CC0", "uri", "c", Vector3d(1, 1, 1)};
  auto& mesh = chair.model.mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  mesh.triangle_material = {0};
  chair.model.materials = {{{1, 2, 3}, 0}};
  chair.model.textures = {{RgbImage(4, 4), {}}};
  const fs::path dir = seeds.Scratch("pack.tmp");
  (void)world::WritePack({chair}, dir);
  seeds.Move("pack", "manifest.json", dir / "manifest.json");
  seeds.Put("pack_model", "chair", world::EncodeModel(chair.model));
  fs::remove_all(dir);
}

void AddEpisodes(const Seeds& seeds) {
  evaluation::EpisodeFile file;
  evaluation::Episode episode;
  episode.scene_id = "00001-House";
  episode.goals = {"bed", "chair"};
  episode.has_certificate = true;
  episode.floors = {{0, 0.0}, {1, 2.8}};
  episode.certificate = {{1}, {0, 1}};
  episode.cross_floor_required = true;
  episode.first_transition_stage = 1;
  episode.episode_id = evaluation::ContentId(episode);
  file.episodes = {episode};
  file.goals_by_category["House.glb_bed"] = {{7, "bed_7", "bed", {1, 2, 3}, {{1, 1, 1}}}};
  (void)evaluation::WriteEpisodes(seeds.Path("episodes", "ours.json"), file);
  (void)evaluation::WriteEpisodes(seeds.Path("episodes", "ours.json.gz"), file);
  auto picture = std::make_shared<evaluation::StagePicture>();
  picture->picture.rgb = RgbImage(32, 32, {120, 120, 120});
  picture->picture.box = perception::PixelBox{8, 8, 24, 24};
  picture->camera_height_m = 1;
  picture->hfov_deg = 70;
  const std::string name = perception::NameOfPicture(picture->picture);
  file.episodes[0].goals[1] = name;
  file.episodes[0].pictures[name] = picture;
  (void)evaluation::WriteEpisodes(seeds.Path("episodes", "picture.json"), file);
  seeds.Put("episodes", "objectnav.json",
            R"({"episodes":[{"episode_id":"0","scene_id":"hm3d/a/b.glb","start_position":[1,2,3],)"
            R"("start_rotation":[0,0,0,1],"object_category":"bed","goals":[]}],)"
            R"("goals_by_category":{"b.glb_bed":[{"position":[1,2,3],"object_id":3,)"
            R"("object_name":"bed","object_category":"bed","view_points":[{"agent_state":)"
            R"({"position":[1,2,3]}}]}]}})");
  seeds.Put("episodes", "onemap.json",
            R"({"episodes":[{"episode_id":1,"scene_id":"a.glb","start_position":[1,2,3],)"
            R"("start_rotation":[0,0,0,1],"object_goals":["bed","sofa"]}]})");
}

void AddResults(const Seeds& seeds) {
  evaluation::RunHeader header;
  header.variant = "full";
  header.config_json = "{\"sensor\":{\"width_px\":64}}";
  header.episodes = 1;
  header.scenes["house"] = {"0123456789abcdef", "0123456789abcdef"};
  auto record = evaluation::test::MakeEpisode("e1", 2, {{true, 2, 3}, {false, 4, 5}});
  record.stages[1].extra.cause = evaluation::StageCause{{{"go_to", 3}}, "go_to", true, "", {}, 0.5};
  evaluation::EpisodeRecord failed = evaluation::test::MakeEpisode("e2", 1, {});
  failed.failed = evaluation::EpisodeFailure{"crash", "signal 11"};
  seeds.Put("results", "results.jsonl",
            evaluation::ToJsonLine(header) + "\n" + evaluation::ToJsonLine(record) + "\n" +
                evaluation::ToJsonLine(failed) + "\n");
  evaluation::SuiteManifest manifest;
  manifest.suite = "crossnav-mfmon-1-mini";
  manifest.generator_version = 1;
  manifest.furniture = "simple shapes";
  manifest.episodes = 1;
  manifest.first_transitions = {1, 0};
  manifest.episodes_hash = "0123456789abcdef";
  manifest.meshes = {{"00001-House", "0123456789abcdef"}};
  (void)evaluation::WriteManifest(seeds.Path("suite", "suite.json"), manifest);
}

void AddVisits(const Seeds& seeds) {
  evaluation::HouseVisit visit;
  visit.house = "00001-House";
  visit.scene_id = "00001-House-day1";
  visit.day = 1;
  visit.start.p_world = {1, 2, 0};
  visit.goals = {{"chair", "other_floor", false, {0, 1}, {{1, 2, 0}}},
                 {"vase", "removed", true, {}, {}}};
  seeds.Put("visits", "visits.json", evaluation::VisitsText({visit}));
  evaluation::VisitResults results;
  results.run = {"0123", "keep", "full", "4567", "oracle-perception", "1"};
  evaluation::GoalRecord goal;
  goal.goal = "chair", goal.track = "other_floor";
  evaluation::VisitRecord failed;
  failed.house = "00002-House", failed.failure = "signal 11";
  results.records = {{"00001-House", 1, {goal}, 4096, ""}, failed};
  seeds.Put("visits", "visits.jsonl", evaluation::VisitResultsText(results));
}

void AddReplays(const Seeds& seeds) {
  const trace::SampleEpisode sample = trace::MakeSampleEpisode(16);
  const trace::SampleFrame& frame = sample.frames[3];
  seeds.Put("trace_json", "step.json", trace::ToJson(frame.trace, trace::VoxelText::kOmit));
  seeds.Put("trace_json", "info.json", trace::ToJson(sample.info));
  seeds.Put("trace_json", "stage.json", trace::ToJson(sample.stages[0]));
  seeds.Put("trace_json", "sight.json", trace::ToJson(trace::NoteOf(frame.sight)));
  const trace::GraphNote& graph = *sample.frames[10].graph;
  seeds.Put("trace_json", "graph.json", trace::ToJson(graph));
  seeds.Put("voxel_runs", "runs", trace::EncodeVoxelRuns(frame.trace.voxel_changes));
  const fs::path file = seeds.Scratch("replay.tmp");
  {
    trace::ReplayOptions small;
    small.cloud_every_steps = 0;
    auto writer = trace::ReplayWriter::Open(file, sample.info, small);
    (void)writer->Write({frame.trace, &frame.observation, &frame.sight, &graph});
    (void)writer->WriteStage(sample.stages[0]);
    (void)writer->Close();
  }
  seeds.Put("replay", "plain.mcap", PlainMcap(file));
  seeds.Move("replay", "packed.mcap", file);
}

void AddRecordings(const Seeds& seeds) {
  const fs::path data = crossnav::test::SourcePath("tests/recordings/data");
  seeds.Put("recording", "packed.mcap", PlainMcap(data / "packed/packed.mcap"));
  seeds.Put("recording", "raw.mcap", ReadText(data / "raw/raw.mcap"));
  seeds.Put(
      "recording_text", "times.txt",
      "# time file\n1.25 rgb/1.png\n1.50 rgb/2.png\n1.26 0 0 1 0 0 0 1\n1.51 0 1 1 0 0 0 1\n");
  seeds.Put("recording_text", "rows.txt", "0 0 0 0 0 0 1\n1 0 0 0 0 0.7071 0.7071\n");
  seeds.Put("recording_text", "matrix.txt", "1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n");
}

void AddMap(const Seeds& seeds) {
  // As few blocks as possible: each costs every execution.
  store::testing::SmallWorld world;
  const CameraIntrinsics camera = IntrinsicsFromHfov(4, 4, 0.2);
  DepthImage depth(4, 4);
  std::fill(depth.data.begin(), depth.data.end(), 0.3F);
  const Pose T_world_camera = CameraPose({{0.1, 0.1, 0}, 0, 0}, 0.3);
  const std::vector<float> features(store::testing::kDim, 0.5F);
  const auto& pixels = world.map.Integrate(depth, camera, T_world_camera);
  world.memory.Fuse(pixels, depth, camera, T_world_camera, {1, 1, store::testing::kDim, features});
  world.map.UpdateStates();
  const fs::path file = seeds.Scratch("map.tmp");
  (void)store::SaveMemory(file, world.map, world.memory, {});
  seeds.Move("map", "home.map", file);
  geometry::VoxelMap::Cursor cursor(world.map);
  const auto bytes = store::EncodeMapBlock(geometry::ExportBlocks(world.map)[0], cursor);
  seeds.Put("map_block", "map", {bytes.begin(), bytes.end()});
}

void AddTexts(const Seeds& seeds) {
  const std::string defaults = evaluation::DumpToml(evaluation::RunConfig());
  seeds.Put("config", "defaults.toml", defaults);
  seeds.Put("config", "dotted.toml", "[policy]\npoi.use_history = false # comment\n");
  seeds.Put("words", "lines",
            "the red armchair near the window upstairs\nthe second chair in the kitchen\n"
            "where did I last see a toilet?\nhow many chairs are upstairs\n"
            "which rooms have no plant\nwhat is on the table\n");
  seeds.Put("setting", "lines",
            "map.voxel_m=0.1\npolicy.poi.use_history=false\nmap.clearing=\"never\"");
  for (const char* name : {"crossnav_small", "deimv2_atto_coco"}) {
    const fs::path card = crossnav::test::SourcePath("networks/") + (std::string(name) + ".toml");
    seeds.Put("card", name, ReadText(card));
  }
  seeds.Put("card", "text",
            "family = \"paper\"\nfile = \"a.onnx\"\n[input]\nwidth = 8\nheight = 8\n[text]\n"
            "encoder = \"t.onnx\"\ntokenizer = \"clip\"\nvocabulary = \"v.txt\"\nlength = 16\n");
  seeds.Put("tokenizer", "merges.txt", "#version: 0.2\ni n\nt h\na n\nr e\nth e</w>\n");
  seeds.Put("tokenizer", "vocab.txt", "[PAD]\n[UNK]\n[CLS]\n[SEP]\nsofa\n##s\nbed\n");
}

}  // namespace

void WriteSeeds(const fs::path& folder) {
  fs::create_directories(folder);
  const Seeds seeds(folder);
  AddScenes(seeds);
  AddHouses(seeds);
  AddChanges(seeds);
  AddPack(seeds);
  AddEpisodes(seeds);
  AddResults(seeds);
  AddVisits(seeds);
  AddReplays(seeds);
  AddRecordings(seeds);
  AddMap(seeds);
  AddTexts(seeds);
}

}  // namespace crossnav::fuzz
