//! Small buttons whose signs are drawn, since fonts do not have them all.

use egui::{Color32, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2};

/// Sign of a button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Icon {
    /// A bar and a triangle to the left.
    Begin,
    /// A triangle to the right.
    Play,
    /// Two bars.
    Pause,
    /// A full rhombus.
    Key,
    /// An empty rhombus.
    NoKey,
    /// An arrow that goes back.
    Reset,
}

/// A button with a sign. Its name is read aloud.
pub(super) fn button(ui: &mut Ui, icon: Icon, color: Color32, name: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(18.0), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
    let color = if response.hovered() || response.has_focus() { Color32::WHITE } else { color };
    if response.has_focus() {
        let stroke = ui.visuals().selection.stroke;
        ui.painter().rect_stroke(rect, 3.0, stroke, egui::StrokeKind::Inside);
    }
    draw(ui, rect, icon, color);
    response
}

fn draw(ui: &Ui, rect: Rect, icon: Icon, color: Color32) {
    let middle = rect.center();
    let at = |x: f32, y: f32| middle + egui::vec2(x, y);
    let painter = ui.painter();
    let filled = |points: Vec<Pos2>| Shape::convex_polygon(points, color, Stroke::NONE);
    let rhombus = vec![at(0.0, -5.0), at(5.0, 0.0), at(0.0, 5.0), at(-5.0, 0.0)];
    let bar = |x: f32| Rect::from_center_size(at(x, 0.0), egui::vec2(2.6, 10.0));
    match icon {
        Icon::Begin => {
            painter.rect_filled(bar(-4.0), 0.0, color);
            painter.add(filled(vec![at(5.0, -5.0), at(5.0, 5.0), at(-2.0, 0.0)]));
        }
        Icon::Play => {
            painter.add(filled(vec![at(-4.0, -5.5), at(5.5, 0.0), at(-4.0, 5.5)]));
        }
        Icon::Pause => {
            painter.rect_filled(bar(-3.0), 0.0, color);
            painter.rect_filled(bar(3.0), 0.0, color);
        }
        Icon::Key => {
            painter.add(filled(rhombus));
        }
        Icon::NoKey => {
            painter.add(Shape::closed_line(rhombus, Stroke::new(1.2, color)));
        }
        Icon::Reset => {
            painter.add(Shape::line(
                vec![at(-4.0, -2.0), at(2.0, -2.0), at(4.0, 0.0), at(4.0, 3.0), at(-2.0, 3.0)],
                Stroke::new(1.3, color),
            ));
            painter.add(filled(vec![at(-6.0, -2.0), at(-2.0, -5.0), at(-2.0, 1.0)]));
        }
    }
}
