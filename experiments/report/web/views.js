export function showViews() {}
