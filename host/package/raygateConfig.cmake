# find_package(raygate): the target raygate::raygate.
include(CMakeFindDependencyMacro)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/raygateTargets.cmake)
