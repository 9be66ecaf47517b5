// Qt Data Visualization's bars with its own shadow map. Its camera turns a little, so that it draws.
import QtQuick
import QtQuick.Window
import QtDataVisualization
Window {
    id: win
    width: 640; height: 360; visible: true
    property real moved: 0
    Bars3D {
        anchors.fill: parent
        shadowQuality: AbstractGraph3D.ShadowQualityHigh
        msaaSamples: 0
        scene.activeCamera.xRotation: 30 + 0.001 * win.moved
        scene.activeCamera.yRotation: 30
        Bar3DSeries {
            ItemModelBarDataProxy {
                rowRole: "row"; columnRole: "column"; valueRole: "value"
                itemModel: ListModel {
                    ListElement { row: "a"; column: "1"; value: "3" }
                    ListElement { row: "a"; column: "2"; value: "7" }
                    ListElement { row: "a"; column: "3"; value: "4" }
                    ListElement { row: "b"; column: "1"; value: "8" }
                    ListElement { row: "b"; column: "2"; value: "2" }
                    ListElement { row: "b"; column: "3"; value: "6" }
                }
            }
        }
    }
    Timer { interval: 50; running: true; repeat: true; onTriggered: { win.moved = 1 - win.moved } }
}
