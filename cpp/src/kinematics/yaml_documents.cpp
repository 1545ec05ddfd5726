#include "kinematics/yaml_documents.hpp"

#include <yaml-cpp/eventhandler.h>

#include <sstream>

namespace viapoint {
namespace {

/// Notes where the document begins, and nothing else.
class Beginning final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { line = mark.line + 1; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {}
  void OnMapEnd() override {}

  int line = 0;
};

}  // namespace

YamlDocuments load_documents(const std::string& text) {
  YamlDocuments documents;
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Beginning beginning;
  while (documents.count < 2 && parser.HandleNextDocument(beginning)) ++documents.count;
  if (documents.count > 1) documents.second_line = beginning.line;
  documents.first = YAML::Load(text);
  return documents;
}

}  // namespace viapoint
