#include <gmock/gmock.h>

#include <filesystem>

#include "framework/io/gltf.h"
#include "tests/io/glb_file.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using nlohmann::json;
using test::data_error_of;
using test::GlbFile;
using test::square_glb;
using ::testing::HasSubstr;

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 3; ++b) bits = bits << 8 | (i + b < bytes.size() ? bytes[i + b] : 0U);
    for (std::size_t d = 0; d < 4; ++d)
      text += i + d > bytes.size() ? '=' : digits[bits >> (18 - 6 * d) & 63];
  }
  return text;
}

/// The square as a .gltf whose buffer is a file beside it or within.
class GltfBuffers : public test::TestFiles {
 protected:
  GltfBuffers() : square_(square_glb()) { write("square.bin", square_.binary); }

  std::string with_uri(const std::string& uri) const {
    json whole = square_.json;
    whole["buffers"] = {{{"byteLength", square_.binary.size()}, {"uri", uri}}};
    return write("square.gltf", whole.dump());
  }
  std::string error_with(const std::string& uri) const {
    const std::string path = with_uri(uri);
    std::string error = data_error_of([&] { read_gltf(path); });
    EXPECT_THAT(error, HasSubstr(path));
    return error;
  }
  void expect_square(const std::string& path) const {
    const Mesh expected = read_gltf(write("square.glb", square_.bytes()));
    const Mesh mesh = read_gltf(path);
    EXPECT_EQ(mesh.vertices, expected.vertices);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    EXPECT_EQ(mesh.targets[0].displacements, expected.targets[0].displacements);
  }

  GlbFile square_;
};

TEST_F(GltfBuffers, MayBeFilesBesideIt) { expect_square(with_uri("square.bin")); }

TEST_F(GltfBuffers, MayHaveNamesThatAreEscaped) {
  std::filesystem::create_directory(file("a b"));
  write("a b/\xC3\xA4.bin", square_.binary);
  expect_square(with_uri("a%20b/%C3%A4.bin"));
}

TEST_F(GltfBuffers, MayBeWithin) {
  // Of every length that base64 fills up differently.
  for (int i = 0; i < 3; ++i) {
    expect_square(with_uri("data:application/octet-stream;base64," + base64(square_.binary)));
    square_.binary.push_back(7);
  }
}

TEST_F(GltfBuffers, MayBeginWithAByteOrderMark) {
  const auto bytes = read_file(with_uri("square.bin"));
  expect_square(write("marked.gltf", "\xEF\xBB\xBF" + std::string(bytes.begin(), bytes.end())));
}

TEST_F(GltfBuffers, MayBeOfBothKindsInOneFile) {
  GlbFile glb = square_glb();
  glb.json["buffers"] = {{{"byteLength", glb.binary.size()}},
                         {{"byteLength", glb.binary.size()}, {"uri", "square.bin"}}};
  for (json& view : glb.json["bufferViews"]) view["buffer"] = 1;
  glb.json["bufferViews"][0]["buffer"] = 0;
  expect_square(write("both.glb", glb.bytes()));
}

TEST_F(GltfBuffers, AMissingOneIsNamed) {
  EXPECT_THAT(error_with("none.bin"), HasSubstr(file("none.bin") + ": no such file"));
  EXPECT_THAT(error_with("."), HasSubstr("is a folder"));
}

TEST_F(GltfBuffers, OneThatIsTooShortIsNamed) {
  square_.binary.pop_back();
  write("short.bin", square_.binary);
  square_.binary.push_back(0);
  EXPECT_THAT(error_with("short.bin"), HasSubstr("a buffer of 124 bytes, but \"short.bin\" has 123"));
  EXPECT_THAT(error_with("data:;base64,AAAA"), HasSubstr("has 3"));
}

TEST_F(GltfBuffers, NamesThatAreNoneAreErrors) {
  EXPECT_THAT(error_with("https://example.org/square.bin"), HasSubstr("expected a file or data"));
  EXPECT_THAT(error_with(""), HasSubstr("expected a file or data"));
  EXPECT_THAT(error_with("square%2.bin"), HasSubstr("not escaped properly"));
  EXPECT_THAT(error_with("square%00.bin"), HasSubstr("not escaped properly"));
  EXPECT_THAT(error_with("data:text/plain,hello"), HasSubstr("not base64"));
  EXPECT_THAT(error_with("data:;base64,AA*A"), HasSubstr("not base64"));
  EXPECT_THAT(error_with("data:;base64,AAAAA"), HasSubstr("cut short"));
}

TEST_F(GltfBuffers, ABufferWithoutDataIsAnError) {
  json whole = square_.json;
  whole["buffers"] = {{{"byteLength", square_.binary.size()}}};
  const std::string path = write("square.gltf", whole.dump());
  EXPECT_THAT(data_error_of([&] { read_gltf(path); }), HasSubstr("the binary chunk has 0"));
}

TEST_F(GltfBuffers, OnlyGltf2IsRead) {
  for (const auto& [asset, expected] :
       std::vector<std::pair<json, std::string>>{{{{"version", "1.0"}}, "glTF version \"1.0\", expected 2.0"},
                                                 {{{"version", 2}}, "glTF version 2, expected 2.0"},
                                                 {json::object(), "'asset' with a 'version' is missing"}}) {
    square_.json["asset"] = asset;
    EXPECT_THAT(error_with("square.bin"), HasSubstr(expected));
  }
  const std::string path = write("broken.gltf", std::string("{\"asset\": {\"version\": \"2.0\"}"));
  EXPECT_THAT(data_error_of([&] { read_gltf(path); }), HasSubstr("its JSON is damaged"));
}

}  // namespace
}  // namespace pliant
