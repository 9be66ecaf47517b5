// A sun on a ground, a cube, a ball and a pole, by Qt Quick 3D's own shadow map. SHADOW_* in the environment change the light.
import QtQuick
import QtQuick.Window
import QtQuick3D
Window {
    id: win
    width: 640; height: 360; visible: true; color: "black"
    property var given: Qt.application.arguments.slice(-1)[0].split("=")  // NAME=VALUE as the last argument
    function setting(name, otherwise) { return given[0] === name ? Number(given[1]) : otherwise }
    View3D {
        anchors.fill: parent
        environment: SceneEnvironment { backgroundMode: SceneEnvironment.Color; clearColor: "#203040"; antialiasingMode: SceneEnvironment.NoAA }
        PerspectiveCamera { position: Qt.vector3d(300, 350, 600); eulerRotation: Qt.vector3d(-25, 25, 0); clipNear: 10; clipFar: 3000 }
        DirectionalLight {
            eulerRotation: Qt.vector3d(-50, -40 + 0.001 * win.moved, 0)
            castsShadow: true; shadowMapFar: 3000; shadowFactor: 75
            shadowBias: win.setting("SHADOW_BIAS", 0)
            shadowMapQuality: [Light.ShadowMapQualityLow, Light.ShadowMapQualityMedium, Light.ShadowMapQualityHigh, Light.ShadowMapQualityVeryHigh][win.setting("SHADOW_QUALITY", 2)]
        }
        Model { source: "#Rectangle"; scale: Qt.vector3d(12, 12, 1); eulerRotation.x: -90; materials: DefaultMaterial { diffuseColor: "#a0a0a0"; specularAmount: 0 } }
        Model { source: "#Cube"; y: 60; x: -50; eulerRotation.y: 20; materials: DefaultMaterial { diffuseColor: "#c04040"; specularAmount: 0; cullMode: win.setting("SHADOW_CULL", 1) } }
        Model { source: "#Sphere"; y: 120; x: 150; z: -80; materials: DefaultMaterial { diffuseColor: "#40c040"; specularAmount: 0 } }
        Model { source: "#Cylinder"; y: 50; x: 120; z: 180; scale: Qt.vector3d(0.4, 1, 0.4); materials: DefaultMaterial { diffuseColor: "#4040c0"; specularAmount: 0 } }
    }
    property real moved: 0
    Timer { interval: 16; running: true; repeat: true; onTriggered: { win.moved = 1 - win.moved } }  // Qt draws its map again when something moved
}
