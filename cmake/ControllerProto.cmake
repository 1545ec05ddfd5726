# The messages of proto/viapoint/controller.proto: for C++ as the library viapoint_controller_proto,
# for Python as the descriptors in ${viapoint_descriptors}.
find_package(Protobuf REQUIRED)
find_package(gRPC CONFIG REQUIRED)

set(generated "${CMAKE_CURRENT_BINARY_DIR}/generated")
set(proto_folder "${PROJECT_SOURCE_DIR}/proto")
set(proto viapoint/controller)
set(viapoint_descriptors "${CMAKE_CURRENT_BINARY_DIR}/controller.binpb")
set(outputs "${generated}/${proto}.pb.cc" "${generated}/${proto}.pb.h" "${viapoint_descriptors}")
file(MAKE_DIRECTORY "${generated}")
add_custom_command(
  OUTPUT ${outputs}
  COMMAND protobuf::protoc -I "${proto_folder}" "--cpp_out=${generated}"
    "--descriptor_set_out=${viapoint_descriptors}" ${proto}.proto
  DEPENDS "${proto_folder}/${proto}.proto"
  VERBATIM)
add_library(viapoint_controller_proto STATIC ${outputs})
# Generated code is not ours to warn about.
target_compile_options(viapoint_controller_proto PRIVATE -w)
target_include_directories(viapoint_controller_proto SYSTEM PUBLIC "${generated}")
target_link_libraries(viapoint_controller_proto PUBLIC gRPC::grpc++ protobuf::libprotobuf)
